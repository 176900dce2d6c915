#include "dem/replay/recording.h"

#include <fmt/core.h>

#include "dem/base/error.h"

namespace granrad {

double recorded_time_s(const Snapshot& snapshot, const Scene& scene) {
  return scene.step_s > 0 ? static_cast<double>(snapshot.bed.step) * scene.step_s : snapshot.bed.time_s;
}

void Recording::rewind() {
  file_ = place_ = 0;
  open_.reset();
  first_s_.reset(), last_s_.reset();
}

std::optional<Snapshot> Recording::next() {
  const auto& files = scene_.replay.files;
  while (open_ ? place_ >= open_->steps().size() : file_ < files.size()) {
    if (open_) {
      open_.reset();
      if (file_ == files.size()) break;
    } else {
      open_ = std::make_unique<SnapshotFile>(files[file_++], 0.5 * scene_.particle_diameter_m);
      place_ = 0;
    }
  }
  if (!open_) return {};
  Snapshot snapshot = open_->read(place_++);
  double time_s = recorded_time_s(snapshot, scene_);
  if (!first_s_) first_s_ = time_s;
  time_s -= *first_s_;
  if (last_s_ && !(time_s > *last_s_))
    throw InputError(advised(
        fmt::format(
            "{}: step {} is at {:g} s, the snapshot before it at {:g} s (times of a recording must rise)",
            snapshot.origin, snapshot.bed.step, time_s + *first_s_, *last_s_ + *first_s_),
        "give dem.step_s, the step of the recorded flow, where files have no time"));
  last_s_ = time_s;
  snapshot.bed.time_s = time_s;
  take_into_scene(snapshot, scene_);
  return snapshot;
}

}  // namespace granrad
