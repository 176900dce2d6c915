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

}  // namespace

ParticleTable::ParticleTable(std::string file, std::size_t header_line, std::vector<std::string> columns,
                             double radius_m)
    : file_(std::move(file)), names_(std::move(columns)), radius_m_(radius_m) {
  const std::vector<const char*> names[count] = {{"id"},
                                                 {"x", "xu"},
                                                 {"y", "yu"},
                                                 {"z", "zu"},
                                                 {"radius"},
                                                 {"diameter"},
                                                 {"temperature", "T", "Temp", "f_Temp[0]", "f_Temp"},
                                                 {"vx"},
                                                 {"vy"},
                                                 {"vz"},
                                                 {"omegax"},
                                                 {"omegay"},
                                                 {"omegaz"},
                                                 {"material"}};
  for (int column = 0; column < count; ++column) at_[column] = position_of(names[column], header_line);
  std::vector<std::string> missing;
  for (const Column needed : {x, y, z})
    if (at_[needed] < 0) missing.emplace_back(names[needed][0]);
  if (at_[radius] < 0 && at_[diameter] < 0 && !(radius_m_ > 0)) missing.emplace_back("radius");
  if (missing.empty()) return;
  throw InputError(
      fmt::format("{}:{}: no column {} (columns are {}){}", file_, header_line, fmt::join(missing, ", "),
                  fmt::join(names_, ", "),
                  missing.back() == "radius" ? " add it, or give the radius of all particles" : ""));
}

int ParticleTable::position_of(const std::vector<const char*>& aliases, std::size_t header_line) {
  for (const char* alias : aliases) {
    const auto at = std::find(names_.begin(), names_.end(), alias);
    if (at == names_.end()) continue;
    if (std::find(at + 1, names_.end(), alias) != names_.end())
      throw InputError(fmt::format("{}:{}: column {} is given twice", file_, header_line, alias));
    return static_cast<int>(at - names_.begin());
  }
  return -1;
}

void ParticleTable::problem(std::size_t line, const std::string& what) {
  if (problem_count_++ < problems_shown) problems_.push_back(fmt::format("{}:{}: {}", file_, line, what));
}

double ParticleTable::number(Column column, std::size_t line, const std::vector<std::string_view>& fields,
                             double absent) {
  if (at_[column] < 0) return absent;
  std::string_view text = fields[at_[column]];
  double value = 0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto refuse = [&](const char* why) {
    problem(line, fmt::format("{} = {} ({})", names_[at_[column]], text.empty() ? "nothing" : text, why));
    return 1.0;
  };
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return refuse("must be a finite number");
  const bool positive = column == radius || column == diameter || column == temperature;
  if (positive && !(value > 0)) return refuse("must be > 0");
  if (column == material && value > 65535) return refuse("must be a material number");
  const bool whole = column == id || column == material;
  if (whole && (value != std::floor(value) || value < 0 || value > largest_exact_integer))
    return refuse("must be a whole number >= 0");
  return value;
}

void ParticleTable::add_row(std::size_t line, const std::vector<std::string_view>& fields) {
  if (fields.size() != names_.size())
    return problem(line,
                   fmt::format("{} values (the header names {} columns)", fields.size(), names_.size()));
  const auto read = [&](Column column, double absent = 0) { return number(column, line, fields, absent); };
  Bed& bed = snapshot_.bed;
  const Vec3 position{read(x), read(y), read(z)}, velocity{read(vx), read(vy), read(vz)};
  const double r = at_[radius] >= 0 ? read(radius) : at_[diameter] >= 0 ? 0.5 * read(diameter) : radius_m_;
  bed.add(position, velocity, r, read(temperature, 300), static_cast<std::int32_t>(read(material)));
  bed.angular_velocity_rad_s.back() = {read(omegax), read(omegay), read(omegaz)};
  if (at_[id] >= 0) bed.id.back() = static_cast<std::int64_t>(read(id));
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
      problem(line_[order[k]], fmt::format("id = {} (also on line {}) ids must differ", bed.id[order[k]],
                                           line_[order[k - 1]]));
  bed.permute(order);
  if (bed.size() > 0) bed.next_id = bed.id.back() + 1;
  snapshot_.file_row = std::move(order);
}

Snapshot ParticleTable::finish() {
  if (at_[id] >= 0) sort_by_id();
  if (problem_count_ > problems_shown)
    problems_.push_back(fmt::format("{}: and {} more problems", file_, problem_count_ - problems_shown));
  if (!problems_.empty()) throw InputError(problems_);
  snapshot_.origin = file_;
  snapshot_.has_temperature = at_[temperature] >= 0;
  return std::move(snapshot_);
}

}  // namespace granrad
