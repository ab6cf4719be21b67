/// The integrators by name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "materials/bsdf.h"
#include "renderer/session/integrator.h"

namespace parian {

/// Which samples find direct light: lights alone, directions of the BSDF alone, or both combined by multiple
/// importance sampling. Lights that only sampling them can find (point, spot, directional) are sampled in all
/// three.
enum class Strategy : std::uint8_t { mis, light, bsdf };

/// What light does inside a body that scatters it: a random walk, the truth; diffusion by one of the models
/// (materials/diffusion.h) where the body is dense; by place the cheaper of the two that is near enough to
/// the truth; or, as a first look, all comes out where it went in.
enum class Subsurface : std::uint8_t {
  automatic,
  random_walk,
  dipole,
  better_dipole,
  burley,
  photon_beam,
  off
};

struct IntegratorSettings {
  Strategy strategy = Strategy::mis;
  Subsurface subsurface = Subsurface::automatic;
  Microfacets microfacets = Microfacets::compensated;
  int max_depth = 100;           // scattering events of a path at most
  float clamp = kInfinity;       // radiance of a path at most, by its largest component; biased where finite
  float occlusion_distance = 0;  // ao: how far an occluder counts; 0: any distance
};

/// `name` is one of integrator_names(); throws UsageError otherwise.
std::unique_ptr<Integrator> make_integrator(const std::string& name, const IntegratorSettings& settings);
std::vector<std::string> integrator_names();

}  // namespace parian
