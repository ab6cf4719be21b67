/// What reading a file and Embree's own build of its triangles take, with nothing around them: what loading a
/// large model is measured against.
///
/// usage: bare_build SCENE.glb
/// Prints one line of JSON: seconds to read the file, seconds (wall and CPU) of one parallel build of all
/// meshes that are drawn, each where its file has it, and the bytes that Embree holds then.
#include <fmt/format.h>

#include <atomic>
#include <cstdio>

#include "renderer/accel/embree.h"
#include "renderer/base/memory.h"
#include "renderer/scene/world.h"
#include "scene_io/gltf/gltf.h"
#include "tests/bench/support/timing.h"

namespace {

using namespace parian;

bool count_bytes(void* user, ssize_t bytes, bool) {
  static_cast<std::atomic<std::ptrdiff_t>*>(user)->fetch_add(bytes);
  return true;
}

/// By the plainest means.
double read_seconds(const char* path) {
  const double start = seconds(CLOCK_MONOTONIC);
  std::FILE* const file = std::fopen(path, "rb");
  std::fseek(file, 0, SEEK_END);
  const auto size = std::size_t(std::ftell(file));
  std::rewind(file);
  const PageBuffer bytes(size);
  const bool whole = std::fread(bytes.data(), 1, size, file) == size;
  std::fclose(file);
  return whole ? seconds(CLOCK_MONOTONIC) - start : -1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} SCENE.glb\n", argv[0]);
    return 2;
  }
  const double read = read_seconds(argv[1]);
  std::vector<std::string> notes;
  const Scene scene = load_scene({argv[1]}, {}, notes);

  std::atomic<std::ptrdiff_t> bytes{0};
  const double start = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
  RTCDevice device = rtcNewDevice(nullptr);
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
  RTCScene built = rtcNewScene(device);
  rtcSetSceneFlags(built, RTC_SCENE_FLAG_ROBUST);
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& p : mesh.primitives) {
      if (!p.positions.padded()) continue;
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, p.positions.data(),
                                 0, sizeof(Vec3f), p.positions.size());
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, p.triangles.data(), 0,
                                 sizeof(Triangle), p.triangles.size());
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(built, geometry);
      rtcReleaseGeometry(geometry);
      triangles += p.triangles.size();
    }
  rtcCommitScene(built);
  fmt::print(
      "{{\"triangles\": {}, \"read\": {:.4f}, \"build\": {:.4f}, \"build_cpu\": {:.4f}, \"bytes\": {}}}\n",
      triangles, read, seconds(CLOCK_MONOTONIC) - start, seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu,
      bytes.load());
  rtcReleaseScene(built);
  rtcReleaseDevice(device);
  return 0;
}
