#include "scene_io/gltf/write/layout.h"

#include <algorithm>
#include <array>
#include <utility>

#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

constexpr std::size_t kAlignment = 4;

/// Bytes of a source's buffer that go into the file in one piece.
struct Range {
  std::size_t begin, end, place = 0;
};

class Layout {
 public:
  explicit Layout(Draft& draft) : draft_(draft), ranges_(draft.buffers.size()) {}

  std::vector<Piece> make() {
    json* const views = find_array(draft_.root, array::kBufferViews);
    const std::size_t count = views ? views->size() : 0;
    const std::size_t sourced = std::min(draft_.data.first_view, count);
    for (std::size_t i = 0; i < sourced; ++i) for_each_use((*views)[i], [&](json& use) { add_range(use); });
    json buffers = make_buffers();
    for (std::size_t b = 0; b < ranges_.size(); ++b) place(b);
    for (std::size_t i = 0; i < sourced; ++i) for_each_use((*views)[i], [&](json& use) { move(use); });
    for (std::size_t i = sourced; i < count; ++i) {
      align(0);
      // Their order is that of the pieces.
      Piece& piece = draft_.data.pieces[i - sourced];
      (*views)[i]["byteOffset"] = size_;
      append(std::move(piece));
    }
    if (size_ > 0) buffers[0]["byteLength"] = size_;
    if (size_ == 0) buffers.erase(0);
    draft_.root["buffers"] = std::move(buffers);
    return std::move(pieces_);
  }

 private:
  /// The parts of a bufferView that say where bytes lie: itself, and its compressed form.
  template <class Body>
  static void for_each_use(json& view, const Body& body) {
    body(view);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (json* const packed = find_extension(view, name)) body(*packed);
  }

  std::span<const std::byte> bytes_of(const json& use) const {
    return draft_.buffers[use["buffer"].get<std::size_t>()];
  }

  void add_range(const json& use) {
    if (bytes_of(use).empty()) return;
    const auto begin = use.value("byteOffset", std::size_t(0));
    ranges_[use["buffer"].get<std::size_t>()].push_back(
        {begin, begin + use["byteLength"].get<std::size_t>()});
  }

  /// The first is for all bytes; behind it are those that have none and still are fallen back to.
  json make_buffers() {
    json& sources = need_array(draft_.root, array::kBuffers);
    const std::vector<bool> referenced = find_referenced(draft_.root).at(array::kBuffers);
    json buffers = json::array({json::object()});
    numbers_.assign(sources.size(), 0);
    bool named = false;
    for (std::size_t b = 0; b < sources.size(); ++b) {
      if (!referenced[b]) continue;
      if (draft_.buffers[b].empty()) {
        numbers_[b] = buffers.size();
        buffers.push_back(std::move(sources[b]));
      } else if (!std::exchange(named, true)) {
        buffers[0] = std::move(sources[b]);
        buffers[0].erase("uri");
      }
    }
    return buffers;
  }

  /// Ranges of one buffer that touch or overlap become one, and get their places.
  void place(std::size_t buffer) {
    std::vector<Range>& ranges = ranges_[buffer];
    std::ranges::sort(ranges, {}, &Range::begin);
    std::vector<Range> joined;
    for (const Range& range : ranges) {
      if (!joined.empty() && range.begin <= joined.back().end)
        joined.back().end = std::max(joined.back().end, range.end);
      else
        joined.push_back(range);
    }
    for (Range& range : joined) {
      align(range.begin);
      range.place = size_;
      const auto bytes = draft_.buffers[buffer].subspan(range.begin, range.end - range.begin);
      append({bytes.size(), [bytes](FileWriter& file) { file.write(bytes.data(), bytes.size()); }});
    }
    ranges = std::move(joined);
  }

  void move(json& use) {
    const auto buffer = use["buffer"].get<std::size_t>();
    use["buffer"] = numbers_[buffer];
    if (draft_.buffers[buffer].empty()) return;
    const auto begin = use.value("byteOffset", std::size_t(0));
    const auto& ranges = ranges_[buffer];
    const auto range = std::prev(std::ranges::upper_bound(ranges, begin, {}, &Range::begin));
    const std::size_t offset = range->place + (begin - range->begin);
    if (offset != 0 || use.contains("byteOffset")) use["byteOffset"] = offset;
  }

  /// A gap up to the next place that is `residue` modulo the alignment.
  void align(std::size_t residue) {
    static constexpr std::array<char, kAlignment> kZeros{};
    const std::size_t gap = (residue % kAlignment + kAlignment - size_ % kAlignment) % kAlignment;
    if (gap > 0) append({gap, [gap](FileWriter& file) { file.write(kZeros.data(), gap); }});
  }

  void append(Piece piece) {
    size_ += piece.bytes;
    pieces_.push_back(std::move(piece));
  }

  Draft& draft_;
  std::vector<std::vector<Range>> ranges_;  // by buffer of the sources
  std::vector<std::size_t> numbers_;        // their new numbers
  std::vector<Piece> pieces_;
  std::size_t size_ = 0;
};

}  // namespace

std::vector<Piece> lay_out(Draft& draft) { return Layout(draft).make(); }

std::size_t total_bytes(const std::vector<Piece>& pieces) {
  std::size_t total = 0;
  for (const Piece& piece : pieces) total += piece.bytes;
  return total;
}

}  // namespace parian
