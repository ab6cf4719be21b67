/// What a file holds compressed: EXT_meshopt_compression and KHR_draco_mesh_compression. Afterwards the
/// document reads as if it had never been compressed: bufferViews of decoded bytes stand where the compressed
/// ones stood.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include "scene_io/gltf/file/document.h"

namespace parian {

/// Decodes both, in parallel, each stream once. Comes between read_document() and check_document(). Throws
/// InputError.
void decompress(GltfDocument& document);

/// Whether decompress() has anything to do.
bool is_compressed(const GltfDocument& document);

/// What codecs may allocate for one document: so many bytes for each byte of its files, and some for small
/// ones. Streams may overlap in the file, so what one of them can honestly hold does not bound them all.
class DecodingBudget {
 public:
  DecodingBudget(const GltfDocument& document, std::size_t growth);
  /// False if that is more than is left. Throws std::runtime_error where all that was claimed is more than
  /// the memory limit left when decoding began. For any thread.
  bool claim(std::size_t bytes);

 private:
  const std::string file_;
  const std::size_t room_;  // in memory
  const std::size_t most_;
  std::atomic<std::size_t> claimed_{0};
};

/// Makes `bytes` a buffer of the document. Returns its index.
int add_buffer(GltfDocument& document, SharedArray<std::byte> bytes);

// The two parts of decompress().
void decode_meshopt(GltfDocument& document);
void decode_draco(GltfDocument& document);

/// The EXT_meshopt_compression of a bufferView, or nullptr.
const tinygltf::Value* meshopt_extension(const tinygltf::BufferView& view);

/// For each of `count` buffers, whether it is only what bufferViews fall back to where a reader knows no
/// EXT_meshopt_compression: it is never read, and need not be there.
std::vector<bool> fallback_buffers(const tinygltf::Model& model, std::size_t count);

}  // namespace parian
