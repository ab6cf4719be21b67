/// The thin diffuse sheet: paper, a leaf, a lampshade.
#pragma once

#include "materials/lobe.h"
#include "renderer/base/sampling.h"

namespace parian {

/// f = reflected / pi on the side of the viewer and transmitted / pi on the other, as
/// KHR_materials_diffuse_transmission has its diffuse base; loses nothing where the two add to 1.
struct DiffuseTransmissionLobe {
  Rgb reflected, transmitted;

  BsdfValue eval(const Vec3f&, const Vec3f& wi) const {
    const float cosine_over_pi = kInvPi * std::abs(wi.z), choice = reflection_probability();
    if (wi.z > 0) return {reflected * cosine_over_pi, choice * cosine_over_pi};
    return {transmitted * cosine_over_pi, (1 - choice) * cosine_over_pi};
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    Vec3f wi = sample_cosine_hemisphere(u2);
    if (!(u1 < reflection_probability())) wi.z = -wi.z;
    const BsdfValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1 / value.pdf), value.pdf};
  }

 private:
  float reflection_probability() const {
    const float r = luminance(reflected), t = luminance(transmitted);
    return t <= 0 ? 1 : r / (r + t);
  }
};
static_assert(Lobe<DiffuseTransmissionLobe>);

}  // namespace parian
