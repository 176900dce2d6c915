// Requirement: a trace that a signal cuts short throws in place of handing on a part of its rays, with a watch and
// without one. Planted: thrown only where there is a watch.
#include "raytrace/rays/ray_monitor.h"

#include <gtest/gtest.h>

#include <csignal>

#include "dem/base/program.h"

using namespace granrad;

TEST(RayMonitor, ASignalThrowsWithoutAWatchToo) {
  install_signal_handlers();
  RayMonitor before({}, 1);
  EXPECT_TRUE(before.go_on(1));
  EXPECT_NO_THROW(before.throw_if_stopped());
  std::raise(SIGINT);
  RayMonitor without({}, 1), with([](double) { return true; }, 1);
  EXPECT_FALSE(without.go_on(1));
  EXPECT_THROW(without.throw_if_stopped(), TraceStopped);
  EXPECT_FALSE(with.go_on(1));
  EXPECT_THROW(with.throw_if_stopped(), TraceStopped);
}
