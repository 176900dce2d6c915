#include "fit/fitting/fit_table.h"

#include "fit/fitting/left_out.h"

namespace granrad {

TableFit fit_table(std::size_t count, const RowSamples& samples, const FitOptions& options,
                   const std::function<void(double part)>& done) {
  TableFit fit;
  const double steps = 2 * static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    fit.rows.push_back(fit_row(samples(k), options));
    done(static_cast<double>(k + 1) / steps);
  }
  fit.table = make_table(fit.rows, options);
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const auto apart = left_out(fit.table, k, samples(k), options);
    fit.rows[k].pp.left_out_rmse = fit.rows[k].row.statistics.pp_left_out_rmse = apart.pp_rmse;
    fit.rows[k].pw.left_out_rmse = fit.rows[k].row.statistics.pw_left_out_rmse = apart.pw_rmse;
    fit.table.rows[k].statistics = fit.rows[k].row.statistics;
    done(static_cast<double>(count + k) / steps);
  }
  done(1);
  return fit;
}

}  // namespace granrad
