/// OpenImageIO's name of a type of texels; for the files that know it.
#pragma once

#include <OpenImageIO/typedesc.h>

#include "renderer/scene/image.h"

namespace parian::oiio {

inline OIIO::TypeDesc oiio_type(PixelType type) {
  switch (type) {
    case PixelType::u8:
      return OIIO::TypeDesc::UINT8;
    case PixelType::u16:
      return OIIO::TypeDesc::UINT16;
    case PixelType::f16:
      return OIIO::TypeDesc::HALF;
    case PixelType::f32:
      break;
  }
  return OIIO::TypeDesc::FLOAT;
}

}  // namespace parian::oiio
