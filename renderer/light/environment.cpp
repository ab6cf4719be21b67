#include "renderer/light/environment.h"

#include "renderer/base/sampling.h"
#include "renderer/scene/texture.h"

namespace parian {
namespace {

Affine to_affine(const Quatf& q) {
  return {q.rotateVector({1, 0, 0}), q.rotateVector({0, 1, 0}), q.rotateVector({0, 0, 1}), {0, 0, 0}};
}

/// Mean luminance of the bilinear lookup over the cell of texel (x, y): its neighbours count 1/8 along each
/// axis. The sampling density then covers all that a bright texel spreads to.
float cell_luminance(const Image& image, int x, int y) {
  const float weight[3] = {0.125f, 0.75f, 0.125f};
  float sum = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const Vec4f c = texel(image, (x + i + image.width) % image.width,
                            std::clamp(y + j, 0, image.height - 1), ColorSpace::srgb);
      sum += weight[i + 1] * weight[j + 1] *
             luminance({std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f)});
    }
  return sum;
}

}  // namespace

EnvironmentLight::EnvironmentLight(const Scene& scene) {
  const Environment& environment = scene.environment;
  if (is_black(environment.radiance)) return;
  scene_ = &scene;
  radiance_ = environment.radiance;
  rotation_ = to_affine(environment.rotation);
  mean_luminance_ = luminance(radiance_);
  texture_ = {environment.image, Wrap::repeat, Wrap::clamp_to_edge, Filter::linear};
  if (environment.image == kNone) return;
  const Image& image = scene.images[environment.image];
  distribution_ = Distribution2D(image.width, image.height, [&](int x, int y) {
    return cell_luminance(image, x, y) * std::sin(kPi * (float(y) + 0.5f) / float(image.height));
  });
  // Mean over the sphere: each cell covers 2 pi^2 sin(theta) / (width height) of 4 pi.
  mean_luminance_ *= float(distribution_.total() * kPi / 2 / (double(image.width) * image.height));
}

Vec2f EnvironmentLight::to_uv(const Vec3f& d, float& sin_theta) const {
  const Vec3f local(rotation_.x.dot(d), rotation_.y.dot(d), rotation_.z.dot(d));
  // Not the arc cosine of y, which loses the angle near the poles.
  sin_theta = std::sqrt(local.x * local.x + local.z * local.z);
  return {0.5f + angle_of(local.x, local.z) * (0.5f * kInvPi), angle_of(local.y, sin_theta) * kInvPi};
}

Rgb EnvironmentLight::eval_image(const Vec2f& uv) const {
  const Vec4f c = eval_texture(*scene_, texture_, uv, ColorSpace::srgb);
  return radiance_ * Rgb(std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f));
}

Rgb EnvironmentLight::eval(const Vec3f& d) const {
  if (texture_.image == kNone) return radiance_;
  float sin_theta;
  return eval_image(to_uv(d, sin_theta));
}

EnvironmentSample EnvironmentLight::look_up(const Vec3f& d) const {
  if (texture_.image == kNone) return {d, radiance_, 0.25f * kInvPi};
  float sin_theta;
  const Vec2f uv = to_uv(d, sin_theta);
  const float density = distribution_.pdf({uv.x - std::floor(uv.x), uv.y});
  return {d, eval_image(uv), sin_theta > 0 ? density / (2 * kPi * kPi * sin_theta) : 0};
}

EnvironmentSample EnvironmentLight::sample(const Vec2f& u) const {
  if (texture_.image == kNone) return {sample_sphere(u), radiance_, 0.25f * kInvPi};
  const Distribution2D::Sample s = distribution_.sample(u);
  // Longitude 2 pi (u - 1/2) and polar angle pi v.
  const Vec2f longitude = -unit_circle(s.p.x), polar = unit_circle(0.5f * s.p.y);
  const float sin_theta = polar.y;
  const Vec3f local(sin_theta * longitude.x, polar.x, sin_theta * longitude.y);
  return {rotation_.vector(local), eval_image(s.p), sin_theta > 0 ? s.pdf / (2 * kPi * kPi * sin_theta) : 0};
}

}  // namespace parian
