#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/study/study_results.h"

namespace granrad {

/// A curve through points of the study: y(x) with coefficients a, b, c, their errors and R2, all as quantities.
struct FittedCurve {
  StudyFit of;
  std::string formula;  ///< of x, coefficients put in
  Quantities coefficient;
  std::size_t points = 0;
  std::string problem;  ///< why there is none
};

/// Fits every [[fit]] of the study to its finished points by `vfgen curve` (files in folder/fits).
std::vector<FittedCurve> fit_curves(const Study& study, const std::vector<StudyRow>& rows,
                                    const std::filesystem::path& folder);

/// A number that someone printed or that is known exactly: a line of a CSV file with the columns
/// id,quantity,class,place,claim,unit,reference,uncertainty,tolerance_pct,ours,why (any order, text cells may be
/// quoted). An uncertainty of ? is not known: without a tolerance there is no verdict. `ours` is a formula of {POINT:QUANTITY} and {fit NAME:COEFFICIENT}; empty: not reproducible as
/// stated, or what the column verdict says, and `why` tells. An empty reference: a statement without a number, ours is told beside it.
struct Claim {
  std::string id, quantity, kind, place, text, unit, ours, why, verdict;
  double reference = 0, uncertainty = 0, tolerance_pct = 0;
};

/// A claim beside what the study found. agrees: within tolerance_pct of the reference, or without a tolerance
/// within two standard errors of ours and the reference together. differs; not reproducible as stated; not run.
struct Judgement {
  Claim claim;
  Measured ours;
  double difference_pct = 0;
  std::string verdict;
  std::vector<std::string> points;  ///< of the study, whose cases made it
};

/// Throws InputError (no such point or quantity, a cell that is no number), IoError.
std::vector<Judgement> judge(const std::filesystem::path& claims, const Study& study,
                             const std::vector<StudyRow>& rows, const std::vector<FittedCurve>& curves);

std::string claims_csv(const std::vector<Judgement>& judged);

/// "3.32 ± 0.02": two digits of the error, and as many of the value.
std::string with_error(const Measured& measured);

/// Bias and relative standard deviation of one quantity, as the FDS Validation Guide (NIST SP 1018-3, ch. 4) states
/// them: with r = ours / reference over n claims, s^2 = var(ln r), and sigma_E the root mean square of the relative
/// standard uncertainties of the references (and of ours beside them), sigma_M^2 = max(0, s^2 - sigma_E^2) and
/// 1 + bias = exp(mean(ln r) + (sigma_M^2 - sigma_E^2) / 2). In per cent. One claim alone: r - 1, and no sigma.
struct QuantityBias {
  std::string quantity;
  std::size_t count = 0;
  double bias_pct = 0, sigma_pct = 0;
  double reference_pct = 0;  ///< sigma_E; nan: unknown for one of them, then sigma_M holds it too
};
std::vector<QuantityBias> biases(const std::vector<Judgement>& judged);

}  // namespace granrad
