#pragma once
#include <array>
#include <cstdint>

#include "dem/base/aligned.h"
#include "dem/base/vec3.h"

namespace granrad::native {

/// The tangential springs of a list of contacts, one column for each component: doubles, or the floats that
/// the law in single precision leaves (half the traffic).
class SpringColumns {
 public:
  void resize(std::int64_t contacts, bool rounded) {
    for (auto& c : full_) c.resize(rounded ? 0 : contacts);
    for (auto& c : rounded_) c.resize(rounded ? contacts : 0);
    is_rounded_ = rounded;
  }
  Vec3 get(std::int64_t k) const {
    if (is_rounded_) return {rounded_[0][k], rounded_[1][k], rounded_[2][k]};
    return {full_[0][k], full_[1][k], full_[2][k]};
  }
  void put(std::int64_t k, const Vec3& s) {
    for (int a = 0; a < 3; ++a) {
      if (is_rounded_)
        rounded_[a][k] = static_cast<float>(s[a]);
      else
        full_[a][k] = s[a];
    }
  }
  double* full(int component) { return full_[component].data(); }
  float* rounded(int component) { return rounded_[component].data(); }
  std::size_t bytes() const { return 3 * (8 * full_[0].capacity() + 4 * rounded_[0].capacity()); }

 private:
  std::array<AlignedVector<double>, 3> full_;
  std::array<AlignedVector<float>, 3> rounded_;
  bool is_rounded_ = false;
};

}  // namespace granrad::native
