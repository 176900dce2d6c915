#include "coupling/study/claims_book.h"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <set>

#include "dem/base/files/markdown.h"

namespace granrad {

namespace {

std::string bias_table(const std::vector<Judgement>& judged) {
  const auto percent = [](double x) { return std::isfinite(x) ? fmt::format("{:.2f} %", x) : std::string(); };
  std::vector<std::vector<std::string>> rows;
  for (const auto& q : biases(judged))
    rows.push_back({q.quantity, fmt::format("{}", q.count), fmt::format("{:+.2f} %", q.bias_pct),
                    percent(q.sigma_pct),
                    std::isfinite(q.reference_pct) ? percent(q.reference_pct) : "unknown"});
  return "\n## Bias and scatter by quantity\n\nAs the FDS Validation Guide states them, from the logarithms of ours over the "
         "reference: σ_M is the scatter of ours once that of the references, σ_E, is taken off; 0 means that the references "
         "cannot tell. Where an uncertainty is unknown, σ_M holds it too.\n\n" +
         markdown_table({"quantity", "numbers", "bias", "σ_M", "σ_E"}, rows);
}

std::string judgements(const std::vector<Judgement>& judged) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& j : judged) {
    const std::string verdict = j.verdict == "differs" ? "**differs**" : j.verdict;
    rows.push_back(
        {j.claim.id, j.claim.quantity, j.claim.text, j.claim.kind,
         fmt::format("{} {}", with_error(j.ours), j.claim.unit),
         std::isfinite(j.claim.reference) ? with_error({j.claim.reference, j.claim.uncertainty}) : "",
         std::isfinite(j.difference_pct) ? fmt::format("{:+.2f} %", j.difference_pct) : "",
         j.claim.tolerance_pct > 0 ? fmt::format("{} (≤ {:g} %)", verdict, j.claim.tolerance_pct) : verdict});
  }
  return markdown_table({"", "quantity", "case", "class", "ours", "reference", "bias", "verdict"}, rows);
}

std::string verdicts(const std::vector<Judgement>& judged) {
  std::map<std::string, int> count;
  for (const auto& j : judged) ++count[j.verdict];
  std::string text;
  for (const auto& [verdict, n] : count) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, verdict);
  return fmt::format("{} numbers: {}.\n\n", judged.size(), text);
}

/// Which versions of the program the cases are of.
std::string made_by(const StudyOutcome& outcome) {
  std::map<std::string, int> count;
  for (const auto& row : outcome.rows)
    for (const auto& record : row.records)
      if (record.status == "finished") ++count[record.version];
  std::string text;
  for (const auto& [version, n] : count)
    text += fmt::format("{}{} ({} cases)", text.empty() ? "Made by granrad " : ", ", version, n);
  return text.empty() ? "" : text + ". ";
}

}  // namespace

std::string claims_book(const StudyOutcome& outcome) {
  bool whole = true;
  for (const auto& row : outcome.rows) whole = whole && row.status() == "finished";
  const std::string stem = outcome.study.file.stem().string();
  std::string text = fmt::format("# {}\n\n", outcome.study.title);
  text += fmt::format(
      "Written by `granrun study data/studies/{}.toml -o out/{} --book FILE` ({}) from `{}`; a second run gives the "
      "same. {}Class: **A** exact or by quadrature, **E** experiment, **P** published computation or fit, **R** another "
      "program. *agrees*: within the tolerance stated, or where none is stated within two standard errors of ours and "
      "the reference together; *uncertainty unknown*: the source states none. Failures stay in the table.\n\n",
      stem, stem, stem == "validation" ? "`./do validate`" : "`./do paper`",
      outcome.study.claims.filename().string(),
      whole ? "" : "**A part of the study**: numbers of cases that were not run say so. ");
  text += made_by(outcome) + verdicts(outcome.judged);
  text += judgements(outcome.judged) + bias_table(outcome.judged);
  text += "\n## Notes, and the command that makes each number\n\n";
  for (const auto& j : outcome.judged) {
    text += fmt::format("- **{}** {} {}", j.claim.id, j.claim.place, j.claim.why);
    if (j.claim.ours.find("{fit ") != std::string::npos)
      text += fmt::format(" A fit over its group: `granrun study data/studies/{} -o out/{}`.",
                          outcome.study.file.filename().string(), outcome.study.file.stem().string());
    std::set<std::string> told;
    for (const auto& point : j.points)
      if (told.insert(point).second)
        text +=
            fmt::format(" `granrun study data/studies/{} -o out/{} --case {}`.",
                        outcome.study.file.filename().string(), outcome.study.file.stem().string(), point);
    text += "\n";
  }
  return text;
}

}  // namespace granrad
