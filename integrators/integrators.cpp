#include "integrators/integrators.h"

#include <fmt/ranges.h>
#include "integrators/ambient_occlusion.h"
#include "integrators/first_hit.h"
#include "integrators/path.h"

#include "renderer/base/error.h"

namespace parian {
namespace {

using Make = std::unique_ptr<Integrator> (*)(const IntegratorSettings&);

template <FirstHitIntegrator::Property property>
std::unique_ptr<Integrator> make_first_hit(const IntegratorSettings&) {
  return std::make_unique<FirstHitIntegrator>(property);
}

const struct {
  const char* name;
  Make make;
} kIntegrators[] = {
    {"path",
     [](const IntegratorSettings& s) -> std::unique_ptr<Integrator> {
       return std::make_unique<PathIntegrator>(s);
     }},
    {"ao",
     [](const IntegratorSettings& s) -> std::unique_ptr<Integrator> {
       return std::make_unique<AmbientOcclusionIntegrator>(s);
     }},
    {"albedo", make_first_hit<FirstHitIntegrator::Property::albedo>},
    {"normal", make_first_hit<FirstHitIntegrator::Property::normal>},
    {"depth", make_first_hit<FirstHitIntegrator::Property::depth>},
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(const std::string& name, const IntegratorSettings& settings) {
  for (const auto& entry : kIntegrators)
    if (name == entry.name) return entry.make(settings);
  throw UsageError(
      fmt::format("no integrator \"{}\"; there are: {}", name, fmt::join(integrator_names(), ", ")));
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const auto& entry : kIntegrators) names.emplace_back(entry.name);
  return names;
}

}  // namespace parian
