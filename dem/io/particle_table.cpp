#include "dem/io/particle_table.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr std::size_t problems_shown = 20;
constexpr double largest_exact_integer = 9007199254740992.0;  // 2^53
constexpr double most_materials = 65535;
constexpr auto quantity_count = static_cast<std::size_t>(Quantity::count);

}  // namespace

ParticleTable::ParticleTable(std::string file, std::size_t header_line, std::vector<std::string> columns,
                             double radius_m, RowsAre rows)
    : file_(std::move(file)),
      names_(std::move(columns)),
      radius_m_(radius_m),
      rows_(rows),
      values_(quantity_count) {
  refuse_names(header_line);
}

void ParticleTable::refuse_names(std::size_t header_line) const {
  const std::string at = header_line > 0 ? fmt::format("{}:{}: ", file_, header_line) : file_ + ": ";
  std::vector<std::string> problems;
  for (const std::string& problem : names_.problems()) problems.push_back(at + problem);
  const bool sized = names_.has(Quantity::radius) || names_.has(Quantity::diameter);
  std::vector<std::string> missing;
  for (const auto& [needed, name] :
       {std::pair{Quantity::x, "x"}, std::pair{Quantity::y, "y"}, std::pair{Quantity::z, "z"}})
    if (!names_.has(needed)) missing.emplace_back(name);
  if (!sized && !(radius_m_ > 0)) missing.emplace_back("radius");
  if (!missing.empty() && problems.empty()) {
    const std::string cause = fmt::format("{}no column {} (columns are {})", at, fmt::join(missing, ", "),
                                          fmt::join(names_.all(), ", "));
    problems.push_back(
        missing.back() == "radius" ? advised(cause, "add it, or give the radius of all particles") : cause);
  }
  if (!problems.empty()) throw InputError(problems);
}

std::string ParticleTable::place(std::size_t line) const {
  return rows_ == RowsAre::lines ? fmt::format("{}:{}", file_, line)
                                 : fmt::format("{}: point {}", file_, line);
}

void ParticleTable::problem(std::size_t line, const std::string& what) {
  if (problem_count_++ < problems_shown) problems_.push_back(fmt::format("{}: {}", place(line), what));
}

double ParticleTable::parsed(std::size_t column, std::size_t line, std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value)) return value;
  problem(line, fmt::format("{} = {} (must be a finite number)", names_.all()[column],
                            text.empty() ? "nothing" : text));
  return 1;
}

double ParticleTable::checked(Quantity quantity, std::size_t line, double value) {
  const auto refuse = [&](const char* why) {
    problem(line, fmt::format("{} = {} ({})", names_.all()[static_cast<std::size_t>(names_.at(quantity))],
                              value, why));
    return 1.0;
  };
  if (!std::isfinite(value)) return refuse("must be a finite number");
  using enum Quantity;
  if ((quantity == radius || quantity == diameter || quantity == temperature) && !(value > 0))
    return refuse("must be > 0");
  if (quantity == type && !(value >= 1 && value <= most_materials && value == std::floor(value)))
    return refuse("must be a type number, from 1");
  if (quantity == material && value > most_materials) return refuse("must be a material number");
  if ((quantity == id || quantity == material) &&
      (value != std::floor(value) || value < 0 || value > largest_exact_integer))
    return refuse("must be a whole number >= 0");
  return value;
}

void ParticleTable::add_row(std::size_t line, const std::vector<std::string_view>& fields) {
  if (fields.size() != names_.all().size())
    return problem(
        line, fmt::format("{} values (the header names {} columns)", fields.size(), names_.all().size()));
  std::vector<double>& values = values_;
  for (std::size_t q = 0; q < quantity_count; ++q)
    if (const int column = names_.at(static_cast<Quantity>(q)); column >= 0)
      values[q] = parsed(static_cast<std::size_t>(column), line, fields[static_cast<std::size_t>(column)]);
  add(line, values);
}

void ParticleTable::add_row(std::size_t line, const std::vector<double>& numbers) {
  for (std::size_t q = 0; q < quantity_count; ++q)
    if (const int column = names_.at(static_cast<Quantity>(q)); column >= 0)
      values_[q] = numbers[static_cast<std::size_t>(column)];
  add(line, values_);
}

void ParticleTable::add(std::size_t line, const std::vector<double>& values) {
  using enum Quantity;
  const auto read = [&](Quantity quantity, double absent = 0) {
    return names_.has(quantity) ? checked(quantity, line, values[static_cast<std::size_t>(quantity)])
                                : absent;
  };
  Bed& bed = snapshot_.bed;
  const Vec3 position{read(x), read(y), read(z)}, velocity{read(vx), read(vy), read(vz)};
  const double r = names_.has(radius)     ? read(radius)
                   : names_.has(diameter) ? 0.5 * read(diameter)
                                          : radius_m_;
  const double number = names_.has(material) ? read(material) : read(type, 1) - 1;
  bed.add(position, velocity, r, read(temperature, 300), static_cast<std::int32_t>(number));
  bed.angular_velocity_rad_s.back() = {read(omegax), read(omegay), read(omegaz)};
  bed.radiative_heat_W.back() = read(q_rad);
  bed.solid_heat_W.back() = read(q_ss);
  bed.gas_heat_W.back() = read(q_sfs);
  if (names_.has(id)) bed.id.back() = static_cast<std::int64_t>(read(id));
  line_.push_back(line);
}

void ParticleTable::sort_by_id() {
  Bed& bed = snapshot_.bed;
  std::vector<std::size_t> order(bed.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return bed.id[a] < bed.id[b]; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (bed.id[order[k]] == bed.id[order[k - 1]] && problem_count_ == 0)
      problem(line_[order[k]],
              advised(fmt::format("id = {} (also {} {})", bed.id[order[k]],
                                  rows_ == RowsAre::lines ? "on line" : "of point", line_[order[k - 1]]),
                      "ids must differ"));
  bed.permute(order);
  if (bed.size() > 0) bed.next_id = bed.id.back() + 1;
  snapshot_.file_row = std::move(order);
}

Snapshot ParticleTable::finish() {
  if (names_.has(Quantity::id)) sort_by_id();
  if (problem_count_ > problems_shown)
    problems_.push_back(fmt::format("{}: and {} more problems", file_, problem_count_ - problems_shown));
  if (!problems_.empty()) throw InputError(problems_);
  snapshot_.origin = file_;
  snapshot_.has_temperature = names_.has(Quantity::temperature);
  snapshot_.has_radius = names_.has(Quantity::radius) || names_.has(Quantity::diameter);
  snapshot_.has_types = names_.has(Quantity::type) && !names_.has(Quantity::material);
  return std::move(snapshot_);
}

}  // namespace granrad
