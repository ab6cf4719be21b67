/// The pieces that material_properties() is made of.
#pragma once

#include <string>

#include "editing/property_list.h"

namespace parian::edit {

/// Which model decides what a material is, in the order of the choices of the property "type".
enum class MaterialType : std::uint8_t { metallic_roughness, phong, conductor, subsurface };

MaterialType type_of(const Material& material);

/// A new material with all parts, so that each has the values of its struct.
Material fresh_material();

/// Coefficients, per metre, and index of refraction of a scattering material that has that name.
void set_substance(Material& material, const std::string& name);

/// The property "type". A new model takes what it can of the old one's colour: Phong four fifths of the base
/// colour as diffuse, and a gloss; a conductor is aluminium, a subsurface body marble until they are told
/// otherwise. What the new model cannot have beside it goes.
void add_type(PropertyList<Material>& list);

/// What lies in and over a material of that type: toggles for its parts, and the numbers of those that are
/// on.
void add_layers(PropertyList<Material>& list, const Material& material, MaterialType type);

}  // namespace parian::edit
