// A flow is steady when its solid fraction and velocity have stopped drifting, and not before.
#include "fit/generate/flow_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "dem/base/error.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

class History : public testing::Test {
 protected:
  /// Rows every 0.1 s to `end_s`, solid fraction by time.
  template <class Function>
  SteadyState judged(double end_s, Function&& phi, double residence_s, double start_s = 0) {
    std::ofstream out(file_);
    out << "time_s,solid_fraction,mean_velocity_m_s,residence_time_s\n";
    for (int k = 1; 0.1 * k < end_s + 0.05; ++k)
      out << 0.1 * k << ',' << phi(0.1 * k) << ",0.1," << (residence_s > 0 ? std::to_string(residence_s) : "")
          << '\n';
    out.close();
    return judge_steadiness(file_, start_s);
  }
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "history.csv";
};

// A filling channel, exponential with 0.5 s: the drift between the quarters after 2 s is 3 %, after 4 s 0.4 %.
// Planted: the drift of the whole time instead of the second half -> never steady.
TEST_F(History, IsSteadyWhenTheDriftHasStopped) {
  const auto filling = [](double t) { return 0.4 * (1 - std::exp(-t / 0.5)); };
  EXPECT_FALSE(judged(1, filling, 0.5).reached);
  EXPECT_FALSE(judged(1.6, filling, 0.5).reached);
  const auto late = judged(4, filling, 0.5);
  EXPECT_TRUE(late.reached);
  EXPECT_NEAR(late.residence_s, 0.5, 1e-6);
  EXPECT_NEAR(late.from_s, 2, 1e-9);
}

TEST_F(History, WaitsForHalfAResidenceTime) {
  const auto constant = [](double) { return 0.4; };
  EXPECT_FALSE(judged(2, constant, 3).reached);
  EXPECT_TRUE(judged(4, constant, 3).reached);
  EXPECT_TRUE(judged(2, constant, 0).reached);  // nothing leaves: a bed at rest
  EXPECT_FALSE(judged(2, constant, 3, 1.9).reached);
}

TEST_F(History, RefusesWhatIsNoHistory) {
  std::ofstream(file_) << "a,b\n1,2\n";
  EXPECT_THROW(judge_steadiness(file_, 0), InputError);
}

}  // namespace
}  // namespace granrad
