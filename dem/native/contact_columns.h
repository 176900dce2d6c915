#pragma once
#include "dem/base/aligned.h"
#include "dem/native/contact_law.h"
#include "dem/native/kernels.h"

namespace granrad::native {

/// What differs from contact to contact where bodies are not all alike: a column for each of `BodyColumn`, then
/// one for each coefficient of the law.
class ContactColumns {
 public:
  void clear() { columns_.clear(), contacts_ = 0; }
  void resize(std::int64_t contacts) {
    contacts_ = contacts;
    columns_.assign((body_columns + LawCoefficients::count) * contacts, 0);
  }
  struct Side {
    double radius_m;
    FixedScales scales;
  };
  void put(std::int64_t k, const Side& first, const Side& second, const LawCoefficients& law) {
    at(BodyColumn::first_radius, k) = first.radius_m;
    at(BodyColumn::second_radius, k) = second.radius_m;
    at(BodyColumn::first_force_scale, k) = first.scales.force;
    at(BodyColumn::second_force_scale, k) = second.scales.force;
    at(BodyColumn::first_torque_scale, k) = first.scales.torque;
    at(BodyColumn::second_torque_scale, k) = second.scales.torque;
    for (int n = 0; n < LawCoefficients::count; ++n) columns_[(body_columns + n) * contacts_ + k] = law.at(n);
  }
  /// The columns from contact `begin` on.
  VariedView view(std::int64_t begin) const {
    return {contacts_ > 0 ? columns_.data() + begin : nullptr, contacts_};
  }
  std::size_t bytes() const { return sizeof(double) * columns_.capacity(); }

 private:
  double& at(BodyColumn c, std::int64_t k) { return columns_[static_cast<int>(c) * contacts_ + k]; }
  AlignedVector<double> columns_;
  std::int64_t contacts_ = 0;
};

}  // namespace granrad::native
