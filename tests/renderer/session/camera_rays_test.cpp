// The rays of a block side by side against those made one by one.
#include "renderer/session/camera_rays.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace parian {
namespace {

CameraView make_view(const Camera& camera) {
  Scene scene;
  add_camera(scene, camera, look_along({1, 2, 3}, normalize(Vec3f(0.3f, -0.2f, -1))));
  return make_camera_view(scene, place_cameras(scene).at(0), 90, 50);
}

Camera of_kind(Projection projection, bool lens) {
  Camera camera;
  camera.projection = projection;
  if (lens) camera.lens = Lens{.focal_length = 0.1f, .f_stop = 1, .focus_distance = 2};
  return camera;
}

// Caught: columns and rows exchanged where a block is cut off by the picture's edge, lens samples drawn
// before film samples, a sampler that does not move on, a packet without its numbers.
TEST(CameraRays, OfABlockAreThoseOfItsPixels) {
  for (const Camera& camera :
       {of_kind(Projection::perspective, false), of_kind(Projection::perspective, true),
        of_kind(Projection::orthographic, false)})
    for (const FilterKind kind : {FilterKind::blackman_harris, FilterKind::box})
      for (const Tile& block :
           {Tile{8, 4, 12, 8}, Tile{88, 48, 90, 50}, Tile{88, 4, 90, 8}, Tile{0, 48, 4, 50}}) {
        const CameraView view = make_view(camera);
        const PixelFilter filter(kind);
        std::vector<CameraPath> paths;
        for (int y = block.y0; y < block.y1; ++y)
          for (int x = block.x0; x < block.x1; ++x) {
            paths.emplace_back();
            paths.back().sampler = Sampler(SamplerKind::sobol, 1, x, y, 9);
          }
        RayPacket rays;
        generate_rays(view, filter, block, paths, rays);
        ASSERT_EQ(rays.count, int(paths.size()));
        int i = 0;
        for (int y = block.y0; y < block.y1; ++y)
          for (int x = block.x0; x < block.x1; ++x, ++i) {
            Sampler sampler(SamplerKind::sobol, 1, x, y, 9);
            const Vec2f film = Vec2f(float(x) + 0.5f, float(y) + 0.5f) + filter.sample(sampler.next2());
            const Ray ray = generate_ray(view, film, sampler.next2());
            for (const Ray& made : {paths[i].ray, rays.ray(i)}) {
              EXPECT_EQ(made.o, ray.o);
              EXPECT_EQ(made.d, ray.d);
              EXPECT_EQ(made.tmax, kInfinity);
            }
            EXPECT_EQ(rays.random[i], sampler.key());
            EXPECT_EQ(paths[i].sampler.key(), sampler.key());
          }
      }
}

}  // namespace
}  // namespace parian
