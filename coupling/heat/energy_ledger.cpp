#include "coupling/heat/energy_ledger.h"

#include <fmt/format.h>

#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {
/// Of the energy of the bed: temperatures are rounded to 1e-16 of it at every step, which is no defect of smaller heats.
constexpr double least_received = 1e-5;
}  // namespace

void CompensatedSum::add(double term) {
  const double next = sum_ + term;
  lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
  sum_ = next;
}

CompensatedSum CompensatedSum::restored(double sum, double lost) {
  CompensatedSum result;
  result.sum_ = sum;
  result.lost_ = lost;
  return result;
}

void EnergyLedger::start(const Bed& bed) {
  *this = {};
  energy_at_start_J_ = thermal_energy_J(bed);
}

void EnergyLedger::receive(const HeatPaths& heat_J) {
  solid_.add(heat_J.solid);
  gas_.add(heat_J.gas);
  radiation_.add(heat_J.radiation);
}

void EnergyLedger::miss(double heat_J) {
  missed_.add(heat_J);
}

HeatPaths EnergyLedger::received_J() const {
  return {solid_.value(), gas_.value(), radiation_.value()};
}

double EnergyLedger::stored_J(const Bed& bed, double feed_in_J, double feed_out_J) const {
  CompensatedSum sum;
  for (double term : {thermal_energy_J(bed), -energy_at_start_J_, -feed_in_J, feed_out_J}) sum.add(term);
  return sum.value();
}

double EnergyLedger::relative_defect(const Bed& bed, double feed_in_J, double feed_out_J) const {
  const double received = received_J().total();
  const double defect = std::abs(stored_J(bed, feed_in_J, feed_out_J) - received - missed_.value());
  if (defect == 0) return 0;
  const double energy = std::max(thermal_energy_J(bed), energy_at_start_J_);
  const double scale = std::max(std::abs(received), least_received * energy);
  return scale > 0 ? defect / scale : 0;
}

namespace {
const char* const column_names[] = {"solid_J", "gas_J", "radiation_J", "missed_J"};
}

StateBlock EnergyLedger::save() const {
  StateBlock block;
  block.reals["energy_at_start_J"] = {energy_at_start_J_};
  const CompensatedSum* sums[] = {&solid_, &gas_, &radiation_, &missed_};
  for (int k = 0; k < 4; ++k) block.reals[column_names[k]] = {sums[k]->sum(), sums[k]->lost()};
  return block;
}

void EnergyLedger::load(const StateBlock& block) {
  const auto column = [&](const std::string& name, std::size_t size) -> const std::vector<double>& {
    const auto found = block.reals.find(name);
    if (found == block.reals.end() || found->second.size() != size)
      throw InputError(
          fmt::format("energy ledger: column '{}' with {} values is missing (not a frame of a "
                      "heat run); start the run anew",
                      name, size));
    return found->second;
  };
  energy_at_start_J_ = column("energy_at_start_J", 1)[0];
  CompensatedSum* sums[] = {&solid_, &gas_, &radiation_, &missed_};
  for (int k = 0; k < 4; ++k) {
    const auto& saved = column(column_names[k], 2);
    *sums[k] = CompensatedSum::restored(saved[0], saved[1]);
  }
}

}  // namespace granrad
