#pragma once
#include <memory>

#include "dem/engine.h"
#include "dem/scene/scene.h"

namespace granrad {

/// A flow that was computed before, by any program: positions, velocities, radii and materials are those of the
/// snapshots of scene.replay.files, in time. Particles are matched by id: one that is new in a snapshot is added
/// (temperature: of its file, else particles.temperature_K), one that is missing is removed. Temperatures and heats
/// of the others stay as they are. No contact memory; what touches is what overlaps at the positions given.
///
/// Time 0 is the first snapshot. `stepped`: the snapshot nearest in time, so that every set of contacts is one that
/// the recorded flow had; `interpolated`: positions on the straight line between two snapshots (along the shortest
/// way in a periodic box), velocities alike: smooth, but bodies that met between two snapshots may overlap.
///
/// advance sets bed.time_s = until_s; the last snapshot holds from its time on. It throws IoError, InputError for
/// files that cannot be read, or whose times do not rise. A function of the bed's time.
std::unique_ptr<Engine> make_replay_engine(const Scene& scene);

/// From the first snapshot of the recording to its last, s.
double recorded_s(const Scene& scene);

}  // namespace granrad
