/// The camera rays of a block of pixels, made side by side.
#pragma once

#include "renderer/film/filter.h"
#include "renderer/scene/camera.h"
#include "renderer/session/integrator.h"

namespace parian {

/// Gives each path, one for each pixel of the block row by row, the camera ray of its sampler's sample, and
/// puts the rays into the packet.
void generate_rays(const CameraView& view, const PixelFilter& filter, const Tile& block,
                   std::span<CameraPath> paths, RayPacket& rays);

}  // namespace parian
