#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "dem/io/snapshot.h"
#include "dem/scene/scene.h"

namespace granrad {

/// By its step and dem.step_s where that is given, else as its file says; s.
double recorded_time_s(const Snapshot& snapshot, const Scene& scene);

/// The snapshots of a recorded flow, one after the other: every snapshot of each file in turn.
class Recording {
 public:
  explicit Recording(const Scene& scene) : scene_(scene) {}

  /// The next snapshot, its bed.time_s in seconds since the first, its materials those of the scene; nothing after
  /// the last. Throws InputError when its time does not lie after the one before.
  std::optional<Snapshot> next();
  void rewind();

 private:
  const Scene& scene_;
  std::size_t file_ = 0, place_ = 0;
  std::unique_ptr<SnapshotFile> open_;
  std::optional<double> first_s_, last_s_;
};

}  // namespace granrad
