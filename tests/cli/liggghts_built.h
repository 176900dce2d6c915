#pragma once
#include "dem/engine_liggghts.h"
#include "dem/scene/scene.h"

namespace granrad::cli {

/// Whether this build has the engine on LIGGGHTS.
inline bool liggghts_is_built() {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].restitution = 1;
  return liggghts_problems(scene).empty();
}

}  // namespace granrad::cli
