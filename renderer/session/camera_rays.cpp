#include "renderer/session/camera_rays.h"

#include <array>

#include "renderer/base/vectorize.h"

namespace parian {
namespace {

constexpr int kSize = RayPacket::kSize;

/// The points of the film, in pixels, around the pixels' centres, by u in [0,1)^2.
struct FilmPoints {
  float center_x[kSize], center_y[kSize], u[kSize], v[kSize];
};

// What the loops write is local, so that it cannot be what they read, and they become vector code.

PARIAN_VECTORIZE void make_pinhole_rays(const CameraView& view, const PixelFilter& filter,
                                        const FilmPoints& film, RayPacket& rays) {
  float x[kSize], y[kSize];
  for (int i = 0; i < kSize; ++i) {
    const Vec2f offset = filter.sample({film.u[i], film.v[i]});
    x[i] = film.center_x[i] + offset.x;
    y[i] = film.center_y[i] + offset.y;
  }
  float dx[kSize], dy[kSize], dz[kSize];
  for (int i = 0; i < kSize; ++i) {
    const Vec3f d = pinhole_direction(view, {x[i], y[i]});
    dx[i] = d.x;
    dy[i] = d.y;
    dz[i] = d.z;
  }
  for (int i = 0; i < kSize; ++i) {
    rays.ox[i] = view.to_world.origin.x;
    rays.oy[i] = view.to_world.origin.y;
    rays.oz[i] = view.to_world.origin.z;
    rays.dx[i] = dx[i];
    rays.dy[i] = dy[i];
    rays.dz[i] = dz[i];
    rays.tmax[i] = kInfinity;
  }
}

}  // namespace

void generate_rays(const CameraView& view, const PixelFilter& filter, const Tile& block,
                   std::span<CameraPath> paths, RayPacket& rays) {
  std::array<Sampler*, kSize> samplers;
  for (std::size_t i = 0; i < paths.size(); ++i) samplers[i] = &paths[i].sampler;
  std::array<Vec2f, kSize> u{};
  std::array<Vec2f, kSize> lens;
  next2_twice({samplers.data(), paths.size()}, u.data(), lens.data());
  const int width = block.x1 - block.x0;
  FilmPoints film{};
  for (int i = 0; i < int(paths.size()); ++i) {
    film.center_x[i] = float(block.x0 + i % width) + 0.5f;
    film.center_y[i] = float(block.y0 + i / width) + 0.5f;
    film.u[i] = u[i].x;
    film.v[i] = u[i].y;
  }
  if (view.is_pinhole()) {
    make_pinhole_rays(view, filter, film, rays);
    rays.count = int(paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      paths[i].ray = rays.ray(int(i));
      rays.random[i] = paths[i].sampler.key();
    }
    return;
  }
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Vec2f point = Vec2f(film.center_x[i], film.center_y[i]) + filter.sample({film.u[i], film.v[i]});
    paths[i].ray = generate_ray(view, point, lens[i]);
    rays.add(paths[i].ray, paths[i].sampler.key());
  }
}

}  // namespace parian
