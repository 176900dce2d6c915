#pragma once
#include <memory>

#include "dem/engine.h"
#include "dem/native/contact_lists.h"
#include "dem/scene/scene.h"

namespace granrad::native {

/// What tests and the bench may choose beside the public interface; results do not depend on any of it.
struct EngineOptions {
  int threads = 0;      ///< 0: OpenMP's default
  bool adapts = false;  ///< fewer where that is faster, found out in the run; else `threads`, as they are
  ListSchedule schedule{};
  Precision precision = Precision::full;
  bool records_touches = false;      ///< see Engine::touches
  const Kernels* kernels = nullptr;  ///< nullptr: select_kernels()
};

/// Counts of the work done, for the bench.
struct EngineCounts {
  std::int64_t near_pairs = 0, tight_pairs = 0, touching = 0, wall_contacts = 0;
  std::int64_t rebuilds = 0, refreshes = 0;
  std::int64_t list_reads = 0;  ///< near_pairs answered without a second search
  double bytes_per_particle = 0;
};

/// The native engine, see dem/engine_native.h for the method.
class NativeEngine : public Engine {
 public:
  NativeEngine(const Bed& bed, const Vec3& gravity_m_s2, double step_s, const EngineOptions& options = {});
  ~NativeEngine() override;
  void advance(Bed& bed, double until_s) override;
  NearPairs near_pairs(const Bed& bed, double max_gap_m) override;
  void record_touches() override;
  std::optional<Touches> touches(const Bed& bed) const override;
  EngineThreads threads() const override;
  EngineCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace granrad::native
