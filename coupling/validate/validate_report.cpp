#include "coupling/validate/validate_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/files/csv.h"
#include "dem/base/stated_number.h"
#include "dem/page/html_report.h"

namespace granrad {

namespace {

constexpr double goal_pct = 1;

std::string known(double seconds) {
  return std::isfinite(seconds) ? fmt::format("{:.3g}", seconds) : "never";
}

constexpr double noticed_pct = 5;  ///< the head of a page is red beyond it, and beyond three errors

/// Standard error of the mean over the particles, whose fluxes are taken as independent; 0: not known.
double mean_flux_error(const SourceInstant& at) {
  return at.flux_noise_W_m2 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, at.flux_W_m2.size())));
}

/// How far a source is off, in % of the mean flux of the reference, at the first instant.
struct Off {
  std::string label;
  double percent, error;
};

std::vector<Off> sources_off(const ValidatedBed& bed) {
  const SourceInstant& reference = bed.tracks.front().at.front();
  std::vector<Off> all;
  for (std::size_t k = 1; k < bed.tracks.size(); ++k) {
    if (!is_last_step(bed, k)) continue;
    const SourceInstant& at = bed.tracks[k].at.front();
    const double error = std::hypot(mean_flux_error(at), mean_flux_error(reference));
    all.push_back({bed.tracks[k].label, compare(at, reference).flux_error_pct,
                   100 * error / std::abs(reference.mean_flux_W_m2)});
  }
  return all;
}

void add_head(HtmlReport& page, const ValidatedBed& bed) {
  const SourceInstant& reference = bed.tracks.front().at.front();
  auto off = sources_off(bed);
  std::vector<Tile> tiles = {tile("mean flux, " + bed.tracks.front().label, "W/m²", reference.mean_flux_W_m2,
                                  mean_flux_error(reference))};
  for (const auto& one : off) {
    tiles.push_back(tile(one.label + ": mean flux off by", "%", one.percent, one.error));
    if (one.percent > 0) tiles.back().value = fmt::format("+{}", tiles.back().value);
  }
  std::stable_sort(off.begin(), off.end(),
                   [](const Off& a, const Off& b) { return std::abs(a.percent) < std::abs(b.percent); });
  std::string ranking;
  bool within = true;
  for (const auto& one : off) {
    ranking += fmt::format("{}{} {:+.2g} %", ranking.empty() ? "" : ", ", one.label, one.percent);
    within = within && std::abs(one.percent) <= std::max(noticed_pct, 3 * one.error);
  }
  if (!off.empty())
    page.verdict(fmt::format("Mean flux at {:g} s, the closest to the reference first: {}.", reference.time_s,
                             ranking),
                 within);
  page.tiles(tiles);
}

std::vector<std::string> row_cells(const SourceTrack& track, const SourceInstant& at,
                                   const SourceComparison& with) {
  return {track.label,
          track.rays > 0 ? fmt::format("{:.0f}", track.rays) : "",
          fmt::format("{:g}", at.time_s),
          fmt::format("{:.2f}", at.mean_temperature_K),
          fmt::format("{:.1f}", at.mean_flux_W_m2),
          fmt::format("{:+.3f}", with.temperature_error_pct),
          fmt::format("{}{}", with.flux_error_pct > 0 ? "+" : "",
                      stated(with.flux_error_pct, with.flux_noise_pct).text()),
          stated(with.own_rms_pct, with.rms_error_pct).text(),
          fmt::format("{:.1e}", at.energy_defect),
          fmt::format("{:.3g}", track.seconds_per_update),
          known(seconds_to_reach(goal_pct, with, track.seconds_per_update))};
}

void add_table(HtmlReport& page, const ValidatedBed& bed) {
  std::vector<std::vector<std::string>> rows;
  const SourceTrack& reference = bed.tracks.front();
  for (const auto& track : bed.tracks)
    for (std::size_t k = 0; k < track.at.size(); ++k)
      rows.push_back(row_cells(track, track.at[k], compare(track.at[k], reference.at[k])));
  page.table({"source", "rays", "time, s", "mean T, K", "mean flux, W/m²", "T error, %", "flux error, %",
              "particle flux rms, %", "energy defect", "CPU s per update", "CPU s to 1 %"},
             rows);
}

/// One colour a source in every figure: its place among the sources.
int colour_of(const ValidatedBed& bed, const std::string& label) {
  std::vector<std::string> labels;
  for (const auto& track : bed.tracks)
    if (std::find(labels.begin(), labels.end(), track.label) == labels.end()) labels.push_back(track.label);
  return static_cast<int>(std::find(labels.begin(), labels.end(), label) - labels.begin());
}

/// Of the last step of each ladder.
void add_curves(HtmlReport& page, const ValidatedBed& bed) {
  Chart temperature{"Mean particle temperature", "time, s", "T, K", {}, false, false};
  Chart flux{"Mean flux received, at the instants compared", "time, s", "q, W/m²", {}, false, false};
  for (std::size_t k = 0; k < bed.tracks.size(); ++k) {
    const auto& track = bed.tracks[k];
    if (!is_last_step(bed, k)) continue;
    Series curve{track.label, track.curve_time_s, track.curve_temperature_K, {}, false};
    Series points{track.label, {}, {}, {}, true};
    curve.colour = points.colour = colour_of(bed, track.label);
    for (const auto& at : track.at) {
      points.x.push_back(at.time_s);
      points.y.push_back(at.mean_flux_W_m2);
      points.error.push_back(mean_flux_error(at));
    }
    temperature.series.push_back(curve);
    flux.series.push_back(points);
  }
  page.chart(temperature);
  page.chart(flux);
}

/// Of the last step of each ladder.
void add_distributions(HtmlReport& page, const ValidatedBed& bed) {
  std::vector<std::pair<std::string, std::vector<double>>> temperatures, fluxes;
  for (std::size_t k = 0; k < bed.tracks.size(); ++k) {
    if (!is_last_step(bed, k)) continue;
    const auto& track = bed.tracks[k];
    temperatures.emplace_back(track.label, track.at.back().temperature_K);
    fluxes.emplace_back(track.label, track.at.back().flux_W_m2);
  }
  const double time = bed.tracks.front().at.back().time_s;
  page.histogram(fmt::format("Particle temperatures at {:g} s", time), "T, K", temperatures);
  page.histogram(fmt::format("Particle fluxes at {:g} s", time), "q, W/m²", fluxes);
}

/// One line a source, a point a step of its ladder: the error of one update against its price; or, over a run, the price
/// of particle fluxes whose noise is goal_pct against the bias that no number of updates takes out.
void add_speed(HtmlReport& page, const ValidatedBed& bed, bool over_run) {
  Chart chart{
      over_run ? "Speed against error, over a run" : "Speed against error, one update",
      over_run ? "CPU seconds until the noise is 1 %" : "CPU seconds per update (view factors made anew)",
      over_run ? "bias that stays, %" : "particle flux rms, %",
      {},
      true,
      true};
  constexpr double least_pct = 0.01;  // for the logarithm: what is below is lost in the noise
  const SourceInstant& reference = bed.tracks.front().at.front();
  for (std::size_t k = 1; k < bed.tracks.size(); ++k) {
    const auto& track = bed.tracks[k];
    const auto with = compare(track.at.front(), reference);
    const double x =
        over_run ? seconds_until_noise(goal_pct, with, track.seconds_per_update) : track.seconds_per_update;
    if (!std::isfinite(x)) continue;
    auto at = std::find_if(chart.series.begin(), chart.series.end(),
                           [&](const Series& s) { return s.label == track.label; });
    if (at == chart.series.end())
      at = chart.series.insert(
          at, Series{.label = track.label, .x = {}, .y = {}, .points = true, .joined = true});
    at->colour = colour_of(bed, track.label);
    at->x.push_back(x);
    at->y.push_back(std::max(least_pct, over_run ? with.bias_pct : with.own_rms_pct));
    at->error.push_back(with.rms_error_pct);
  }
  if (!chart.series.empty()) page.chart(chart);
}

/// The reference is no truth where it takes one radiosity for a surface: said, and measured where paths are compared.
std::string own_bias(const ValidatedBed& bed) {
  if (!bed.reference_has_one_radiosity) return "";
  std::string text =
      "The reference has a bias of its own: one radiosity for each adiabatic wall and grey surface (about 1 % of the "
      "wall heat with black particles, up to 14 % with grey ones in a dense bed); traced paths have none.";
  for (std::size_t k = 1; k < bed.tracks.size(); ++k)
    if (bed.tracks[k].label == "paths" && is_last_step(bed, k)) {
      const auto& path = bed.tracks[k].at.front();
      const auto& reference = bed.tracks.front().at.front();
      const double error = mean_flux_error(path);
      text += fmt::format(" Against paths its mean flux at {:g} s is {:+.2f} ± {:.2g} % off.", path.time_s,
                          100 * (reference.mean_flux_W_m2 / path.mean_flux_W_m2 - 1),
                          100 * error / std::abs(path.mean_flux_W_m2));
    }
  return text;
}

}  // namespace

bool is_last_step(const ValidatedBed& bed, std::size_t track) {
  for (std::size_t k = track + 1; k < bed.tracks.size(); ++k)
    if (bed.tracks[k].label == bed.tracks[track].label) return false;
  return true;
}

std::string particles_csv(const std::vector<ValidatedBed>& beds) {
  std::string text = "bed,source,rays,time_s,particle,x_m,y_m,z_m,temperature_K,flux_W_m2\n";
  for (const auto& bed : beds)
    for (std::size_t t = 0; t < bed.tracks.size(); ++t) {
      if (!is_last_step(bed, t)) continue;
      const auto& track = bed.tracks[t];
      for (const auto& at : track.at)
        for (std::size_t i = 0; i < at.id.size(); ++i)
          text +=
              fmt::format("{},{},{:.0f},{:.6g},{},{:.9g},{:.9g},{:.9g},{:.7g},{:.6g}\n", text_cell(bed.name),
                          text_cell(track.label), track.rays, at.time_s, at.id[i], at.position_m[i].x,
                          at.position_m[i].y, at.position_m[i].z, at.temperature_K[i], at.flux_W_m2[i]);
    }
  return text;
}

std::string validation_csv(const std::vector<ValidatedBed>& beds) {
  std::string text =
      "solid_fraction,source,rays,time_s,mean_temperature_K,mean_flux_W_m2,temperature_error_pct,flux_error_"
      "pct,"
      "particle_flux_rms_pct,reference_noise_pct,energy_defect,seconds_per_update,bed,emissivity,flux_error_of_it_pct,own_rms_pct,"
      "rms_error_of_it_pct,bias_pct,seconds_to_1_pct,reciprocity_rms\n";
  for (const auto& bed : beds)
    for (const auto& track : bed.tracks)
      for (std::size_t k = 0; k < track.at.size(); ++k) {
        const SourceInstant& at = track.at[k];
        const SourceComparison with = compare(at, bed.tracks.front().at[k]);
        const double within = seconds_to_reach(goal_pct, with, track.seconds_per_update);
        text += fmt::format(
            "{:.6g},{},{:.0f},{:.6g},{:.8g},{:.8g},{:.6g},{:.6g},{:.6g},{:.6g},{:.3e},{:.4g},{},{:g},{:.3g},{:.4g},{:.2g},"
            "{:.4g},{},{:.4g}\n",
            bed.solid_fraction, text_cell(track.label), track.rays, at.time_s, at.mean_temperature_K,
            at.mean_flux_W_m2, with.temperature_error_pct, with.flux_error_pct, with.particle_flux_rms_pct,
            with.reference_noise_pct, at.energy_defect, track.seconds_per_update, text_cell(bed.name),
            bed.emissivity, with.flux_noise_pct, with.own_rms_pct, with.rms_error_pct, with.bias_pct,
            std::isfinite(within) ? fmt::format("{:.4g}", within) : "", at.reciprocity_rms);
      }
  return text;
}

void write_validation_report(const std::filesystem::path& file, const std::string& title,
                             const std::vector<ValidatedBed>& beds) {
  HtmlReport page(title);
  for (const auto& bed : beds) {
    page.heading(fmt::format("{}: {} particles, solid fraction {:.3f}", bed.name, bed.particle_count,
                             bed.solid_fraction));
    add_head(page, bed);
    page.paragraph(fmt::format(
        "Reference: {}. Its particle fluxes are known to {:.2g} % (rms, of the mean flux).",
        bed.tracks.front().label,
        compare(bed.tracks.front().at.front(), bed.tracks.front().at.front()).reference_noise_pct));
    if (const auto bias = own_bias(bed); !bias.empty()) page.paragraph(bias);
    add_table(page, bed);
    add_curves(page, bed);
    add_distributions(page, bed);
    add_speed(page, bed, false);
    add_speed(page, bed, true);
  }
  page.heading("How to read this page");
  page.paragraph(
      "A frozen bed is heated by its walls, once with each exchange source. Errors are against the first "
      "source of each table, the reference. Flux errors are relative to the mean flux of the reference; at late "
      "times both temperature and flux have drifted apart, so early rows judge the view factors and late rows "
      "the heating. The noise of the reference is taken out of the rms over the particles. Over a run the noise of "
      "a source averages out and its bias stays: CPU s to 1 % says when the mean flux of each particle is within 1 % "
      "(rms), or never; the last figure shows both parts.");
  page.provenance_of_this_process();
  page.write(file);
}

}  // namespace granrad
