#pragma once
#include "dem/scene/scene.h"

namespace granrad {

/// Particle-steps a second that the engine of a scene makes on this machine in a bed in contact: measured for a third of a
/// second on a cube of touching spheres of the scene's material, up to 8000 and not more than `particles`, that slides
/// through a period at a tenth of the speed of a free fall through the scene's box. 0 where no engine computes forces.
double speed_in_contact(const Scene& scene, double step_s, double particles, int threads);

}  // namespace granrad
