#include "raytrace/rays/ray_monitor.h"

#include <omp.h>

#include <algorithm>

#include "dem/ranks/ranks.h"

namespace granrad {

bool RayMonitor::go_on(std::int64_t work) {
  if (interrupted_alone()) stopped_ = true;
  if (!watch_) return !stopped_;
  const std::int64_t before = done_.fetch_add(work, std::memory_order_relaxed);
  if (omp_get_thread_num() == 0 && !stopped_ && !watch_(std::min(1.0, static_cast<double>(before) / total_)))
    stopped_ = true;
  return !stopped_;
}

}  // namespace granrad
