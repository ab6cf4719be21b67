/// Interference in a thin film on a surface, as KHR_materials_iridescence has it.
#pragma once

#include "renderer/base/math.h"

namespace parian {

/// Reflectance, in linear Rec.709 and within [0, 1], of a base under a film in air, at a cosine in [0, 1] to
/// the normal (a facet's where there are facets): what stands for Schlick's reflectance in a microfacet lobe.
/// film_ior >= 1; the thickness is in nanometres, >= 0; base_f0 is the base's own reflectance in air at
/// normal incidence, in [0, 1].
///
/// It departs from the extension's notes, which are not normative, in that no channel is above 1, in that at
/// thickness 0 it is Schlick's reflectance of the base, which the film takes over from within 0.03 nm, and in
/// the phase of a base that is denser than the film in some channels and rarer in others. The model itself is
/// off from physics by 0.006 (root mean square) for dielectrics within 45 degrees of the normal, by 0.02
/// within 78; for any f0 by 0.017 and 0.07 (the tests).
Rgb iridescent_reflectance(float cosine, float film_ior, float thickness_nm, const Rgb& base_f0);

}  // namespace parian
