#include "coupling/heat/energy_ledger.h"

#include <fmt/format.h>

#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {
/// Of the energy of the bed: temperatures are rounded to 1e-16 of it at every step, which is no defect of smaller heats.
constexpr double least_received = 1e-5;

const std::vector<double>& column(const StateBlock& block, const std::string& name, std::size_t size) {
  const auto found = block.reals.find(name);
  if (found == block.reals.end() || found->second.size() != size)
    throw InputError(
        fmt::format("energy ledger: column '{}' with {} values is missing (not a frame of a "
                    "heat run); start the run anew",
                    name, size));
  return found->second;
}

std::vector<double> saved(const CompensatedSum& sum) {
  return {sum.sum(), sum.lost()};
}

CompensatedSum restored(const StateBlock& block, const std::string& name) {
  const auto& values = column(block, name, 2);
  return CompensatedSum::restored(values[0], values[1]);
}

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

void PathSums::add(const HeatPaths& heat) {
  for (std::size_t k = 0; k < of_path_.size(); ++k) of_path_[k].add(heat.*HeatPaths::paths()[k].value);
}

HeatPaths PathSums::values() const {
  HeatPaths heat;
  for (std::size_t k = 0; k < of_path_.size(); ++k) heat.*HeatPaths::paths()[k].value = of_path_[k].value();
  return heat;
}

void PathSums::save(StateBlock& block) const {
  for (std::size_t k = 0; k < of_path_.size(); ++k)
    block.reals[HeatPaths::paths()[k].column] = saved(of_path_[k]);
}

void PathSums::load(const StateBlock& block) {
  for (std::size_t k = 0; k < of_path_.size(); ++k)
    of_path_[k] = restored(block, HeatPaths::paths()[k].column);
}

void EnergyLedger::start(const Bed& bed) {
  *this = {};
  energy_at_start_J_ = thermal_energy_J(bed);
}

void EnergyLedger::receive(const HeatPaths& heat_J) {
  received_.add(heat_J);
}

void EnergyLedger::miss(double heat_J) {
  missed_.add(heat_J);
}

HeatPaths EnergyLedger::received_J() const {
  return received_.values();
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

StateBlock EnergyLedger::save() const {
  StateBlock block;
  block.reals["energy_at_start_J"] = {energy_at_start_J_};
  received_.save(block);
  block.reals["missed_J"] = saved(missed_);
  return block;
}

void EnergyLedger::load(const StateBlock& block) {
  energy_at_start_J_ = column(block, "energy_at_start_J", 1)[0];
  received_.load(block);
  missed_ = restored(block, "missed_J");
}

}  // namespace granrad
