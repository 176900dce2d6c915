#include "coupling/study/claims.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/simulation/case_folder.h"
#include "coupling/simulation/history.h"
#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/base/stated_number.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double number(const std::string& cell, const std::string& where, double otherwise) {
  if (cell.empty()) return otherwise;
  char* end = nullptr;
  if (cell == "?") return unknown;
  const double value = std::strtod(cell.c_str(), &end);
  if (*end != '\0') throw InputError(fmt::format("{}: {} (must be a number)", where, cell));
  return value;
}

std::vector<Claim> read_claims(const fs::path& file) {
  const CsvTable table = read_csv(file, true);
  std::vector<Claim> all;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto where = fmt::format("{}:{}", table.file, table.line[row]);
    const auto of = [&](const std::string& name) -> std::string {
      const std::size_t at = table.find(name);
      return at == CsvTable::nowhere ? "" : table.rows[row][at];
    };
    all.push_back({of("id"), of("quantity"), of("class"), of("place"), of("claim"), of("unit"), of("ours"),
                   of("why"), of("verdict"), number(of("reference"), where, unknown),
                   number(of("uncertainty"), where, 0), number(of("tolerance_pct"), where, 0)});
  }
  return all;
}

/// A quantity by its full name; nan where the case has not run, an error where there is none such.
Measured find(const std::string& name, const std::vector<StudyRow>& rows,
              const std::vector<FittedCurve>& curves, std::vector<std::string>& points) {
  const auto colon = name.find(':');
  const std::string point = name.substr(0, colon), what = colon == name.npos ? "" : name.substr(colon + 1);
  if (point.starts_with("fit "))
    for (const auto& curve : curves)
      if (point == "fit " + curve.of.name) {
        const auto found = curve.coefficient.find(what);
        return found == curve.coefficient.end() ? Measured{unknown, 0} : found->second;
      }
  for (const auto& row : rows)
    if (row.of->point == point) {
      points.push_back(point);
      if (row.finished == 0) return {unknown, 0};
      const auto found = row.quantity.find(what);
      if (found == row.quantity.end())
        throw InputError(fmt::format("{{{}}}: case {} has no quantity {}", name, point, what));
      return found->second;
    }
  throw InputError(fmt::format("{{{}}}: there is no such case or fit", name));
}

bool agrees(const Judgement& j) {
  const double apart = std::abs(j.ours.value - j.claim.reference);
  if (j.claim.tolerance_pct > 0) return apart <= j.claim.tolerance_pct / 100 * std::abs(j.claim.reference);
  const double error = std::isfinite(j.ours.error) ? j.ours.error : 0;
  return apart <= 2 * std::hypot(error, j.claim.uncertainty);
}

}  // namespace

std::vector<Judgement> judge(const fs::path& file, const Study&, const std::vector<StudyRow>& rows,
                             const std::vector<FittedCurve>& curves) {
  std::vector<Judgement> all;
  std::vector<std::string> problems;
  for (const auto& claim : read_claims(file)) {
    Judgement j{claim,
                {unknown, 0},
                unknown,
                claim.verdict.empty() ? "not reproducible as stated" : claim.verdict,
                {}};
    try {
      if (!claim.ours.empty()) {
        j.ours = evaluate_with_braces(
            claim.ours, [&](const std::string& name) { return find(name, rows, curves, j.points); });
        j.difference_pct = 100 * (j.ours.value / claim.reference - 1);
        j.verdict = !std::isfinite(j.ours.value)                                    ? "not run"
                    : !std::isfinite(claim.reference)                               ? "told"
                    : claim.tolerance_pct <= 0 && !std::isfinite(claim.uncertainty) ? "uncertainty unknown"
                    : agrees(j)                                                     ? "agrees"
                                                                                    : "differs";
      }
    } catch (const InputError& error) {
      problems.push_back(fmt::format("{}: claim {}: {}", file.string(), claim.id, error.what()));
    }
    all.push_back(std::move(j));
  }
  if (!problems.empty()) throw InputError(problems);
  return all;
}

std::string claims_csv(const std::vector<Judgement>& judged) {
  std::string text =
      "id,quantity,class,place,claim,unit,reference,uncertainty,ours,ours_stderr,difference_pct,verdict,why\n";
  for (const auto& j : judged)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", text_cell(j.claim.id),
                        text_cell(j.claim.quantity), text_cell(j.claim.kind), text_cell(j.claim.place),
                        text_cell(j.claim.text), text_cell(j.claim.unit), cell(j.claim.reference, 6),
                        cell(j.claim.uncertainty, 3), cell(j.ours.value, 6), cell(j.ours.error, 2),
                        cell(j.difference_pct, 3), j.verdict, text_cell(j.claim.why));
  return text;
}

std::string with_error(const Measured& m) {
  return stated(m.value, m.error).text();
}

std::vector<QuantityBias> biases(const std::vector<Judgement>& judged) {
  std::vector<QuantityBias> all;
  for (const auto& j : judged) {
    if (!std::isfinite(j.difference_pct)) continue;
    if (!(j.difference_pct > -100)) continue;  // no logarithm: another sign than the reference
    auto at =
        std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.quantity == j.claim.quantity; });
    if (at == all.end()) at = all.insert(all.end(), {j.claim.quantity, 0, 0, 0, 0});
    const double ratio = std::log1p(j.difference_pct / 100), own = j.ours.error / j.ours.value;
    ++at->count;
    at->bias_pct += ratio;
    at->sigma_pct += ratio * ratio;
    at->reference_pct +=
        std::pow(j.claim.uncertainty / j.claim.reference, 2) + (std::isfinite(own) ? own * own : 0);
  }
  for (auto& q : all) {
    const auto n = static_cast<double>(q.count);
    const double mean = q.bias_pct / n, reference = q.reference_pct / n;
    const double scatter = n > 1 ? (q.sigma_pct - n * mean * mean) / (n - 1) : unknown;
    const double known = std::isfinite(reference) ? reference : 0;
    const double model = std::max(0.0, scatter - known);
    q.bias_pct = 100 * (n > 1 ? std::expm1(mean + (model - known) / 2) : std::expm1(mean));
    q.sigma_pct = n > 1 ? 100 * std::sqrt(model) : unknown;
    q.reference_pct = 100 * std::sqrt(reference);
  }
  return all;
}

}  // namespace granrad
