#include "dem/io/column_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "dem/base/error.h"
#include "dem/base/suggestion.h"

namespace granrad {

namespace {

using Words = std::vector<std::string>;

/// What a single column is called: as the programs of this field write it, the first found holds; and plain forms (see
/// `plain`).
struct NamesOf {
  Quantity quantity;
  Words exact, plain{};
};

const std::vector<NamesOf>& names_of_columns() {
  using enum Quantity;
  static const std::vector<NamesOf> all{
      {id, {"id"}, {"id", "particleid", "globalid", "globalids", "gid", "atomid"}},
      {x, {"x", "xu"}},
      {y, {"y", "yu"}},
      {z, {"z", "zu"}},
      {radius, {"radius"}, {"radius", "r", "radii"}},
      {diameter, {"diameter"}, {"diameter", "d", "dp", "diam"}},
      {temperature,
       {"temperature", "T", "Temp", "f_Temp[0]", "f_Temp", "f_T", "c_T", "v_T", "d_T"},
       {"temperature", "temp", "t"}},
      {vx, {"vx"}},
      {vy, {"vy"}},
      {vz, {"vz"}},
      {omegax, {"omegax"}},
      {omegay, {"omegay"}},
      {omegaz, {"omegaz"}},
      {material, {"material"}, {"material", "materialid"}},
      {type, {"type"}, {"type", "atomtype", "materialtype", "particletype"}},
      {q_rad, {"q_rad"}, {"qrad"}},
      {q_ss, {"q_ss"}, {"qss"}},
      {q_sfs, {"q_sfs"}, {"qsfs"}},
  };
  return all;
}

const std::string& usual_name(Quantity quantity) {
  return names_of_columns()[static_cast<std::size_t>(quantity)].exact.front();
}

/// Plain forms of vectors; their components follow as x y z or 0 1 2.
const std::vector<std::pair<Quantity, Words>>& plain_vectors() {
  using enum Quantity;
  static const std::vector<std::pair<Quantity, Words>> all{
      {x, {"", "points", "point", "position", "positions", "pos", "coordinates", "coordinate"}},
      {vx, {"v", "vel", "velo", "velocity", "velocities"}},
      {omegax, {"omega", "w", "angularvelocity", "angvel", "rotationalvelocity"}},
  };
  return all;
}

const Words known_words{"temperature", "temp",     "radius", "diameter",
                        "material",    "velocity", "omega"};  ///< for mistyped and foreign names

Quantity meaning(const std::string& known_word) {
  using enum Quantity;
  if (known_word.starts_with("temp")) return temperature;
  if (known_word == "radius") return radius;
  if (known_word == "diameter") return diameter;
  if (known_word == "material") return material;
  return known_word == "omega" ? omegax : vx;
}

/// Lower case; without f_ c_ v_ d_ i_ of a LAMMPS fix, compute, variable or property, and without [k].
std::string bare(std::string_view name) {
  std::string text(name);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (const auto bracket = text.find('[');
      bracket != text.npos && bracket > 0 && text.back() == ']' &&
      std::all_of(text.begin() + static_cast<std::ptrdiff_t>(bracket) + 1, text.end() - 1, ::isdigit))
    text.resize(bracket);
  if (text.size() > 3 && text[1] == '_' && std::string_view("fcvdi").find(text[0]) != std::string_view::npos)
    text.erase(0, 2);
  return text;
}

/// `bare` without an SI unit at its end and without separators.
std::string plain(std::string_view name) {
  std::string text = bare(name);
  for (const char* unit : {"_k", "_m", "_m_s", "_rad_s", "_w", "(k)", "[k]", "(m)", "[m]", "(m/s)", "[m/s]",
                           "(rad/s)", "[rad/s]", "(w)", "[w]"}) {
    const std::string_view end(unit);
    if (text.size() > end.size() && text.ends_with(end)) {
      text.erase(text.size() - end.size());
      break;
    }
  }
  std::erase_if(text, [](char c) { return c == '_' || c == ' ' || c == '-' || c == '.' || c == ':'; });
  return text;
}

/// T with a unit that is not kelvin, or of some part of a particle.
bool short_for_temperature(const std::string& text) {
  static const Words known{"tp",     "t_p",       "t_c",        "t_f",       "t_s",
                           "t_degc", "t_celsius", "t_particle", "t_surface", "t_mean"};
  return std::find(known.begin(), known.end(), text) != known.end() || text.starts_with("t (") ||
         text.starts_with("t [") || text.starts_with("t(") || text.starts_with("t[c") ||
         text.starts_with("t[d");
}

std::optional<Quantity> quantity_of(const std::string& text) {
  for (const auto& of : names_of_columns())
    if (std::find(of.plain.begin(), of.plain.end(), text) != of.plain.end()) return of.quantity;
  if (text.empty()) return {};
  const auto component = std::string_view("x0y1z2").find(text.back());
  if (component == std::string_view::npos) return {};
  const std::string of = text.substr(0, text.size() - 1);
  if (of.empty() && std::isdigit(static_cast<unsigned char>(text.back()))) return {};
  for (const auto& [first, words] : plain_vectors())
    if (std::find(words.begin(), words.end(), of) != words.end())
      return static_cast<Quantity>(static_cast<std::size_t>(first) + component / 2);
  return {};
}

}  // namespace

ColumnNames::ColumnNames(std::vector<std::string> names) : names_(std::move(names)) {
  at_.fill(-1);
  take_exact();
  take_alike();
  refuse_near_misses();
  refuse_other_shapes();
}

bool ColumnNames::taken(std::size_t column) const {
  return std::find(at_.begin(), at_.end(), static_cast<int>(column)) != at_.end();
}

void ColumnNames::take_exact() {
  for (const auto& of : names_of_columns())
    for (const std::string& word : of.exact) {
      const auto found = std::find(names_.begin(), names_.end(), word);
      if (found == names_.end()) continue;
      if (std::find(found + 1, names_.end(), word) != names_.end())
        problems_.push_back(fmt::format("column {} is given twice", word));
      at_[static_cast<std::size_t>(of.quantity)] = static_cast<int>(found - names_.begin());
      break;
    }
}

void ColumnNames::take_alike() {
  const auto known = at_;
  for (std::size_t c = 0; c < names_.size(); ++c) {
    if (taken(c)) continue;
    const auto quantity = quantity_of(plain(names_[c]));
    if (!quantity || known[static_cast<std::size_t>(*quantity)] >= 0) continue;
    int& at = at_[static_cast<std::size_t>(*quantity)];
    if (at >= 0)
      problems_.push_back(
          advised(fmt::format("columns {} and {} could both be the {}", names_[static_cast<std::size_t>(at)],
                              names_[c], usual_name(*quantity)),
                  "rename one of them"));
    else
      at = static_cast<int>(c);
  }
}

void ColumnNames::refuse_near_misses() {
  const bool sized = has(Quantity::radius) || has(Quantity::diameter);
  for (std::size_t c = 0; c < names_.size(); ++c) {
    const std::string text = bare(names_[c]);
    const bool is_some_t = short_for_temperature(text);
    if (taken(c) || (text.size() < 4 && !is_some_t) || text.find("magnitude") != text.npos) continue;
    std::string meant = is_some_t ? "temperature" : closest_word(text, known_words);
    for (const std::string& word : known_words)
      if (text.starts_with(word) && std::string_view("_ ([").find(text.c_str()[word.size()]) != text.npos)
        meant = word;
    if (meant.empty()) continue;
    const Quantity quantity = meaning(meant);
    const bool size = quantity == Quantity::radius || quantity == Quantity::diameter;
    if (has(quantity) || (size && sized) || (quantity == Quantity::material && has(Quantity::type))) continue;
    problems_.push_back(
        advised(fmt::format("column {} is not known; did you mean {}?", names_[c], usual_name(quantity)),
                "rename it (numbers in SI units), or take it out"));
  }
}

void ColumnNames::refuse_other_shapes() {
  for (const std::string& name : names_) {
    const std::string text = bare(name);
    const bool superquadric = text.starts_with("shapex") || text.starts_with("blockiness") ||
                              text.starts_with("roundness1") || text == "shape";
    const bool multisphere = text.find("multisphere") != text.npos || text == "idmultisphere";
    if (!superquadric && !multisphere) continue;
    problems_.push_back(advised(fmt::format("column {} tells of particles that are {} (only spheres are "
                                            "computed)",
                                            name, superquadric ? "superquadrics" : "clumps of spheres"),
                                "write the file without it if the particles are single spheres"));
    return;
  }
}

}  // namespace granrad
