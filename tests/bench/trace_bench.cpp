// Speed against error of ray tracing, side by side: bare Embree with plain Monte Carlo (what one would write
// first), our Embree tracer with Sobol points, and parallel lines. Times are CPU seconds of one thread unless
// said otherwise; errors are those between two independent runs, over sqrt 2. Usage: trace_bench [--quick]
// FOLDER
#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <optional>
#include <random>

#include "dem/base/clock.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/near_pairs.h"
#include "dem/packing/packing.h"
#include "raytrace/embree/embree_tracer.h"
#include "raytrace/line_pass/line_directions.h"
#include "raytrace/line_pass/line_pass.h"
#include "raytrace/lines/line_sweep.h"
#include "raytrace/rays/emission.h"
#include "raytrace/rays/view_factors.h"

using namespace granrad;

namespace {

constexpr double radius = 4e-4;

/// Peak memory since the last reset, MiB (Linux: VmHWM).
double peak_MiB(bool reset = false) {
  if (reset) std::ofstream("/proc/self/clear_refs") << "5";
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kB = 0;
      status >> kB;
      return kB / 1024;
    }
  return 0;
}

struct Case {
  std::size_t count;
  double solid_fraction;
  Enclosure bed;
  std::vector<std::pair<std::size_t, std::size_t>> near;  ///< closer than 1.1 diameters
  std::string name() const { return fmt::format("trace/N{}/phi{:.2f}", count, solid_fraction); }
};

/// Spheres in a box 1 : 0.8 : 1.6 with walls. Small boxes cannot hold the densest packings: the fraction is
/// lowered until the spheres fit, and the one reached is reported.
std::optional<Enclosure> walled_bed(std::size_t count, double fraction) {
  const double volume = static_cast<double>(count) * 4.0 / 3 * pi * std::pow(radius, 3) / fraction;
  const double s = std::cbrt(volume / 1.28);
  PackingRequest request;
  request.where.box = {{0, 0, 0}, {s, 0.8 * s, 1.6 * s}};
  request.radius_m.assign(count, radius);
  request.equilibration_sweeps = 50;
  Enclosure bed;
  try {
    bed.centre_m = pack_spheres(request);
  } catch (const InputError&) {
    return {};
  }
  bed.box = request.where.box;
  return bed;
}

/// `copies`^3 copies of a periodic packing, in walls one radius away from its centres: quick to build.
Enclosure repeated_bed(std::size_t count, double fraction, int copies) {
  const std::size_t part = count / static_cast<std::size_t>(copies * copies * copies);
  const double volume = static_cast<double>(part) * 4.0 / 3 * pi * std::pow(radius, 3) / fraction;
  const double s = std::cbrt(volume / 1.28);
  PackingRequest request;
  request.where = {{{0, 0, 0}, {s, 0.8 * s, 1.6 * s}}, {true, true, true}};
  request.radius_m.assign(part, radius);
  request.equilibration_sweeps = 5;
  const Vec3 period = request.where.box.max, margin{radius, radius, radius};
  const std::vector<Vec3> centres = pack_spheres(request);
  Enclosure bed;
  for (int a = 0; a < copies; ++a)
    for (int b = 0; b < copies; ++b)
      for (int c = 0; c < copies; ++c)
        for (const Vec3& p : centres)
          bed.centre_m.push_back(p + Vec3{a * period.x, b * period.y, c * period.z});
  bed.box = {-margin, copies * period + margin};
  return bed;
}

Case make_case(std::size_t count, double fraction) {
  constexpr std::size_t most_packed = 20000;
  Case c{count, fraction, {}, {}};
  if (count <= most_packed) {
    for (;; c.solid_fraction -= 0.02)
      if (auto bed = walled_bed(count, c.solid_fraction)) {
        c.bed = std::move(*bed);
        break;
      }
  } else {
    int copies = 2;
    while (count / static_cast<std::size_t>(copies * copies * copies) > most_packed) copies *= 2;
    c.bed = repeated_bed(count, fraction, copies);
    c.count = c.bed.centre_m.size();
  }
  c.bed.radius_m.assign(c.count, radius);
  for (std::size_t i = 0; i < c.count; ++i) c.bed.particle.push_back(static_cast<std::int32_t>(i));
  for (const Wall& w : box_walls(c.bed.box)) c.bed.walls.push_back(w);
  Bed bed;
  bed.materials.emplace_back();
  for (const Vec3& p : c.bed.centre_m) bed.add(p, {}, radius, 300);
  for (const NearPair& p : near_pairs(bed, 0.2 * radius).particles) c.near.emplace_back(p.i, p.j);
  return c;
}

/// What a user wants from a trace: by particle, and for pairs in contact or nearly so.
struct Result {
  std::vector<double> near, wall_sum,
      flux;  ///< F of near pairs; F to all walls; F to the hot walls y_min and y_max
  double rays = 0, seconds = 0, build_s = 0, memory_MiB = 0;
  double trace_s = 0;  ///< of `seconds`, spent in finding hits (bare Embree)
};

struct Errors {
  double near = 0, wall_sum = 0, flux = 0, heat = 0;
};

double rms_error(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]) / 2;
  return a.empty() || scale == 0 ? NAN : std::sqrt(sum / static_cast<double>(a.size())) / scale;
}

double rms(const std::vector<double>& a) {
  return a.empty() ? 0
                   : std::sqrt(std::inner_product(a.begin(), a.end(), a.begin(), 0.0) /
                               static_cast<double>(a.size()));
}

double mean(const std::vector<double>& a) {
  return a.empty() ? 0 : std::accumulate(a.begin(), a.end(), 0.0) / static_cast<double>(a.size());
}

Errors compare(const Result& a, const Result& b) {
  const double total_a = mean(a.flux), total_b = mean(b.flux);
  return {rms_error(a.near, b.near, mean(a.near)), rms_error(a.wall_sum, b.wall_sum, mean(a.wall_sum)),
          rms_error(a.flux, b.flux, rms(a.flux)), std::abs(total_a - total_b) / std::sqrt(2.0) / total_a};
}

// ---- bare Embree: SPHERE_POINT, two triangles a wall, independent random rays, a hit on the sphere left is
// filtered

struct SkipSource {
  RTCIntersectContext context;
  unsigned sphere_geometry, source;
};

void skip_source(const RTCFilterFunctionNArguments* args) {
  const auto* skip = reinterpret_cast<const SkipSource*>(args->context);
  if (RTCHitN_primID(args->hit, 1, 0) == skip->source &&
      RTCHitN_geomID(args->hit, 1, 0) == skip->sphere_geometry)
    args->valid[0] = 0;
}

class BareEmbree {
 public:
  explicit BareEmbree(const Enclosure& e)
      : e_(e), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    RTCGeometry spheres = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* v = static_cast<float*>(
        rtcSetNewGeometryBuffer(spheres, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, e.sphere_count()));
    for (std::size_t i = 0; i < e.sphere_count(); ++i) {
      for (int k = 0; k < 3; ++k)
        v[4 * i + static_cast<std::size_t>(k)] = static_cast<float>(e.centre_m[i][k] / radius);
      v[4 * i + 3] = 1;
    }
    rtcSetGeometryIntersectFilterFunction(spheres, skip_source);
    sphere_geometry_ = attach(spheres);
    for (const Wall& wall : e.walls) {
      RTCGeometry quad = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* corner = static_cast<float*>(
          rtcSetNewGeometryBuffer(quad, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4));
      for (std::size_t k = 0; k < 12; ++k)
        corner[k] = static_cast<float>(wall.vertices[k / 3][static_cast<int>(k % 3)] / radius);
      auto* index = static_cast<unsigned*>(
          rtcSetNewGeometryBuffer(quad, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 2));
      for (unsigned k = 0; k < 6; ++k) index[k] = std::array{0u, 1u, 2u, 0u, 2u, 3u}[k];
      attach(quad);
    }
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  /// Surface hit by a ray from sphere i; -1: none.
  std::int64_t hit(std::size_t i, const Emission& ray) const {
    SkipSource skip;
    rtcInitIntersectContext(&skip.context);
    skip.sphere_geometry = sphere_geometry_;
    skip.source = static_cast<unsigned>(i);
    RTCRayHit query{};
    for (int k = 0; k < 3; ++k) {
      (&query.ray.org_x)[k] = static_cast<float>(ray.origin_m[k] / radius);
      (&query.ray.dir_x)[k] = static_cast<float>(ray.direction[k]);
    }
    query.ray.tfar = INFINITY;
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &skip.context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return -1;
    if (query.hit.geomID == sphere_geometry_) return query.hit.primID;
    return static_cast<std::int64_t>(e_.sphere_count() + query.hit.geomID - sphere_geometry_ - 1);
  }

 private:
  unsigned attach(RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    const unsigned id = rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    return id;
  }
  const Enclosure& e_;
  RTCDevice device_;
  RTCScene scene_;
  unsigned sphere_geometry_ = 0;
};

Result bare_embree(const Case& c, double rays_per_particle, unsigned seed) {
  const std::size_t n = c.count;
  Result r{std::vector<double>(c.near.size(), 0), std::vector<double>(n, 0), std::vector<double>(n, 0)};
  peak_MiB(true);
  const double before = cpu_s();
  const BareEmbree tracer(c.bed);
  const Emitter emitter(c.bed);
  r.build_s = cpu_s() - before;
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<std::vector<std::pair<std::int64_t, std::size_t>>> watched(n);  // near partners of each sphere
  for (std::size_t k = 0; k < c.near.size(); ++k) watched[c.near[k].first].emplace_back(c.near[k].second, k);
  const auto rays = static_cast<std::int64_t>(rays_per_particle);
  std::vector<Emission> starts;
  std::vector<std::int64_t> ends;
  const std::size_t batch = std::max<std::size_t>(1, 20000 / static_cast<std::size_t>(rays));
  for (std::size_t from = 0; from < n; from += batch) {
    const std::size_t to = std::min(n, from + batch);
    const double start = cpu_s();
    starts.clear(), ends.clear();
    for (std::size_t i = from; i < to; ++i)
      for (std::int64_t k = 0; k < rays; ++k)
        starts.push_back(emitter.emit(static_cast<std::int32_t>(i), u(generator), u(generator), u(generator),
                                      u(generator)));
    const double generated = cpu_s();
    for (std::size_t k = 0; k < starts.size(); ++k)
      ends.push_back(tracer.hit(from + k / static_cast<std::size_t>(rays), starts[k]));
    const double traced = cpu_s();
    r.seconds += traced - start, r.trace_s += traced - generated;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const std::size_t i = from + k / static_cast<std::size_t>(rays);
      const auto wall = ends[k] - static_cast<std::int64_t>(n);
      r.wall_sum[i] += wall >= 0;
      r.flux[i] += wall == 2 || wall == 3;
      for (const auto& [partner, pair] : watched[i]) r.near[pair] += ends[k] == partner;
    }
  }
  r.rays = static_cast<double>(n) * static_cast<double>(rays);
  r.memory_MiB = peak_MiB();
  for (auto* v : {&r.near, &r.wall_sum, &r.flux})
    for (double& x : *v) x /= static_cast<double>(rays);
  return r;
}

// ---- ours

/// Factors of one row of any sparse estimate: `get(k)` is the entry, `row` its sum.
template <class Get>
void read_rows(const Case& c, const SparsePattern& p, Get&& get, Result& r) {
  const auto n = static_cast<std::int32_t>(c.count);
  r.wall_sum.assign(c.count, 0), r.flux.assign(c.count, 0), r.near.assign(c.near.size(), 0);
  std::vector<double> row(c.count, 0);
  for (std::size_t i = 0; i < c.count; ++i) {
    for (auto k = p.row_begin[i]; k < p.row_begin[i + 1]; ++k) {
      const std::int32_t wall = p.column[k] - n;
      row[i] += get(k);
      if (wall >= 0) r.wall_sum[i] += get(k);
      if (wall == 2 || wall == 3) r.flux[i] += get(k);
    }
    r.wall_sum[i] /= row[i], r.flux[i] /= row[i];
  }
  for (std::size_t q = 0; q < c.near.size(); ++q) {
    const auto [i, j] = c.near[q];
    const auto begin = p.column.begin() + p.row_begin[i], end = p.column.begin() + p.row_begin[i + 1];
    const auto at = std::lower_bound(begin, end, static_cast<std::int32_t>(j));
    if (at != end && *at == static_cast<std::int32_t>(j)) r.near[q] = get(at - p.column.begin()) / row[i];
  }
}

Result embree_sobol(const Case& c, double rays_per_particle, std::uint64_t seed) {
  Result r;
  TraceOptions o;
  o.rays_per_particle = rays_per_particle;
  o.seed = seed;
  o.threads = 1;
  peak_MiB(true);
  const double start = cpu_s();
  const HitCounts counts = trace_view_factors(c.bed, o);
  r.seconds = cpu_s() - start;
  r.memory_MiB = peak_MiB();
  for (auto launched : counts.launched) r.rays += static_cast<double>(launched);
  read_rows(
      c, counts.pattern, [&](std::int64_t k) { return static_cast<double>(counts.hits[k]); }, r);
  return r;
}

LineOptions line_options(int directions, std::uint64_t seed, int threads = 1) {
  LineOptions o;
  o.directions = directions;
  o.seed = seed;
  o.threads = threads;
  return o;
}

Result lines_matrix(const Case& c, int directions, std::uint64_t seed) {
  Result r;
  LineReport report;
  peak_MiB(true);
  const double start = cpu_s();
  const ExchangeAreas x = sweep_exchange_areas(c.bed, line_options(directions, seed), &report);
  r.seconds = cpu_s() - start;
  r.memory_MiB = peak_MiB();
  r.rays = static_cast<double>(report.ray_equivalents);
  read_rows(
      c, x.pattern, [&](std::int64_t k) { return x.value[k]; }, r);
  return r;
}

std::vector<double> hot_walls(const Case& c) {
  std::vector<double> power(c.bed.surface_count(), 0);
  power[c.count + 2] = power[c.count + 3] = 1;
  return power;
}

/// Ends of lines on spheres in one direction: 2 pi r^2 / h^2 each.
double ends_per_direction(const Case& c, double lines_per_disc) {
  return 2 * lines_per_disc * static_cast<double>(c.count);
}

Result lines_heat(const Case& c, int directions, std::uint64_t seed, double lines_per_disc = 12) {
  Result r;
  LineOptions o = line_options(directions, seed);
  o.lines_per_disc = lines_per_disc;
  peak_MiB(true);
  const double start = cpu_s();
  const auto q = sweep_black_heat(c.bed, hot_walls(c), o);
  r.seconds = cpu_s() - start;
  r.memory_MiB = peak_MiB();
  r.rays = ends_per_direction(c, lines_per_disc) * directions * o.replicates;
  const double area = 4 * pi * radius * radius;
  for (std::size_t i = 0; i < c.count; ++i) r.flux.push_back(q[i] / area);
  return r;
}

/// Pairs handed out and forgotten: what the sweep alone costs.
Result lines_pairs(const Case& c, int directions) {
  Result r;
  const double before = cpu_s();
  const LineScene scene(c.bed, 12);
  LinePass pass(scene);
  r.build_s = cpu_s() - before;
  std::int64_t integers = 0, ends = 0;
  const double start = cpu_s();
  for (int k = 0; k < directions; ++k) {
    pass.aim(line_frame(1, 0, k, directions));
    pass.emit([&](const std::int32_t* p, const std::int32_t* end) { integers += end - p; },
              [&](std::int32_t, const std::int32_t*, std::int64_t n) { ends += n; });
  }
  r.seconds = cpu_s() - start;
  r.rays = integers + ends > 0 ? ends_per_direction(c, 12) * directions : 0;
  return r;
}

// ---- tables and figure

struct Row {
  std::string case_name, method;
  Result result;
  std::optional<Errors> errors;
};

struct Point {
  double seconds, error;
  std::string method;
};

class Book {
 public:
  explicit Book(const std::string& folder)
      : folder_(folder), csv_(fmt::output_file(folder + "/trace_bench.csv")) {
    csv_.print(
        "case,method,rays,cpu_seconds,rays_per_second,build_seconds,peak_MiB,error_near_pairs,error_wall_"
        "sums,"
        "error_particle_flux,error_wall_heat\n");
    fmt::print("{:<24} {:<14} {:>9} {:>8} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "case", "method",
               "rays", "cpu s", "Mray/s", "build s", "MiB", "near", "wall sum", "flux", "heat");
  }
  void add(const Case& c, const std::string& method, const Result& r, const std::optional<Errors>& e) {
    const Errors none{NAN, NAN, NAN, NAN}, x = e.value_or(none);
    fmt::print(
        "{:<24} {:<14} {:>9.2e} {:>8.3f} {:>9.2f} {:>8.3f} {:>9.1f} {:>9.2e} {:>9.2e} {:>9.2e} {:>9.2e}\n",
        c.name(), method, r.rays, r.seconds, 1e-6 * r.rays / r.seconds, r.build_s, r.memory_MiB, x.near,
        x.wall_sum, x.flux, x.heat);
    std::fflush(stdout);
    csv_.print("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g},{:.4g},{:.4g},{:.4g}\n", c.name(), method,
               r.rays, r.seconds, r.rays / r.seconds, r.build_s, r.memory_MiB, x.near, x.wall_sum, x.flux,
               x.heat);
    csv_.flush();
  }
  void versus(const std::string& what, double ours, const std::string& peer, double theirs,
              const std::string& unit, bool less_is_better) {
    lines_.push_back(fmt::format("{} ours {:.4g} {} {} {:.4g} {} ratio {:.3g}", what, ours, unit, peer,
                                 theirs, unit, less_is_better ? theirs / ours : ours / theirs));
  }
  void note(const std::string& line) { lines_.push_back(line); }
  void point(const std::string& method, double seconds_per_particle, double error) {
    points_.push_back({seconds_per_particle, error, method});
  }
  void finish() {
    auto file = fmt::output_file(folder_ + "/trace_bench.txt");
    fmt::print("\n");
    for (const auto& line : lines_) fmt::print("{}\n", line), file.print("{}\n", line);
    draw();
  }

 private:
  /// Error of the particle fluxes against CPU time per particle, both logarithmic.
  void draw() {
    double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
    for (const auto& p : points_) {
      x_low = std::min(x_low, p.seconds), x_high = std::max(x_high, p.seconds);
      y_low = std::min(y_low, p.error), y_high = std::max(y_high, p.error);
    }
    const auto decade = [](double v, bool up) {
      return up ? std::ceil(std::log10(v)) : std::floor(std::log10(v));
    };
    const double x0 = decade(x_low, false), x1 = decade(x_high, true), y0 = decade(y_low, false),
                 y1 = decade(y_high, true);
    const auto at_x = [&](double v) { return 70 + 560 * (std::log10(v) - x0) / (x1 - x0); };
    const auto at_y = [&](double v) { return 430 - 390 * (std::log10(v) - y0) / (y1 - y0); };
    auto svg = fmt::output_file(folder_ + "/trace_bench.svg");
    svg.print(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"660\" height=\"490\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n"
        "<rect width=\"660\" height=\"490\" fill=\"white\"/>\n");
    for (double d = x0; d <= x1; ++d)
      svg.print(
          "<path d=\"M{0} 40V430\" stroke=\"#ddd\"/><text x=\"{0}\" y=\"448\" "
          "text-anchor=\"middle\">1e{1:.0f}</text>\n",
          at_x(std::pow(10, d)), d);
    for (double d = y0; d <= y1; ++d)
      svg.print(
          "<path d=\"M70 {0}H630\" stroke=\"#ddd\"/><text x=\"62\" y=\"{0}\" "
          "text-anchor=\"end\">1e{1:.0f}</text>\n",
          at_y(std::pow(10, d)), d);
    svg.print(
        "<text x=\"350\" y=\"472\" text-anchor=\"middle\">CPU seconds per particle</text>\n"
        "<text x=\"70\" y=\"24\">rms relative error of the particle fluxes, wall-heated bed</text>\n");
    const std::pair<const char*, const char*> colours[] = {{"bare embree", "#c0392b"},
                                                           {"embree sobol", "#e08e0b"},
                                                           {"lines matrix", "#2471a3"},
                                                           {"lines heat", "#1e8449"}};
    double legend = 56;
    for (const auto& [method, colour] : colours) {
      svg.print("<circle cx=\"520\" cy=\"{}\" r=\"5\" fill=\"{}\"/><text x=\"532\" y=\"{}\">{}</text>\n",
                legend, colour, legend + 4, method);
      legend += 18;
      for (const auto& p : points_)
        if (p.method == method)
          svg.print("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" fill-opacity=\"0.8\"/>\n",
                    at_x(p.seconds), at_y(p.error), colour);
    }
    svg.print("</svg>\n");
  }

  std::string folder_;
  fmt::ostream csv_;
  std::vector<std::string> lines_;
  std::vector<Point> points_;
};

/// Seconds to reach 1 %, were the error to fall as for independent rays.
double to_one_percent(double seconds, double error) {
  return seconds * std::pow(error / 0.01, 2);
}

/// Directions per replicate such that a run takes about a second.
int directions_for(std::size_t count, double spheres_per_run) {
  return std::max(2, static_cast<int>(spheres_per_run / 4 / static_cast<double>(count)));
}

/// The best of several results, by time.
template <class Run>
Result best_of(int runs, Run&& run) {
  Result best = run();
  for (int k = 1; k < runs; ++k)
    if (Result r = run(); r.seconds < best.seconds) best = std::move(r);
  return best;
}

/// Seconds per particle of each product at the same few directions for any number of particles.
struct Cost {
  double pairs, flux, matrix;
};

Cost cost_per_particle(const Case& c) {
  constexpr int directions = 2;
  const int runs = c.count > 20000 ? 2 : 10;
  const double n = static_cast<double>(c.count);
  return {best_of(runs, [&] { return lines_pairs(c, directions); }).seconds / n,
          best_of(runs, [&] { return lines_heat(c, directions, 1); }).seconds / n,
          best_of(runs, [&] { return lines_matrix(c, directions, 1); }).seconds / n};
}

void compare_cost(Book& book, const Case& c, const Cost& here, const Cost& small) {
  const auto line = [&](const std::string& product, double ours, double theirs) {
    book.versus(c.name() + "/" + product + "_per_particle", 1e9 * ours, "N3600", 1e9 * theirs, "ns", true);
  };
  line("pairs", here.pairs, small.pairs);
  line("flux", here.flux, small.flux);
  line("matrix", here.matrix, small.matrix);
}

void measure(Book& book, const Case& c) {
  const double n = static_cast<double>(c.count);
  const auto both = [&](const std::string& method, auto&& run) {
    const Result a = run(1), b = run(2);
    Errors e = compare(a, b);
    Result shown = a;
    shown.seconds = std::min(a.seconds, b.seconds);
    shown.trace_s = std::min(a.trace_s, b.trace_s);
    book.add(c, method, shown, e);
    book.point(method, shown.seconds / n, e.flux);
    return std::make_pair(shown, e);
  };
  const auto [bare, bare_error] =
      both("bare embree", [&](unsigned seed) { return bare_embree(c, std::max(8.0, 1.5e6 / n), seed); });
  const auto [sobol, sobol_error] =
      both("embree sobol", [&](unsigned seed) { return embree_sobol(c, std::max(8.0, 3e6 / n), seed); });
  const Result pairs = best_of(3, [&] { return lines_pairs(c, directions_for(c.count, 6e6)); });
  book.add(c, "lines pairs", pairs, {});
  const auto [heat, heat_error] =
      both("lines heat", [&](unsigned seed) { return lines_heat(c, directions_for(c.count, 6e6), seed); });
  const auto [matrix, matrix_error] = both(
      "lines matrix", [&](unsigned seed) { return lines_matrix(c, directions_for(c.count, 6e6), seed); });

  // Rates stand against Embree's intersection alone, without the making of its rays; the times to 1 % include
  // it.
  const double bare_rate = 1e-6 * bare.rays / bare.trace_s;
  const auto rate = [](const Result& r) { return 1e-6 * r.rays / r.seconds; };
  book.versus(c.name() + "/pairs", rate(pairs), "embree", bare_rate, "Mray/s", false);
  book.versus(c.name() + "/flux", rate(heat), "embree", bare_rate, "Mray/s", false);
  book.versus(c.name() + "/matrix", rate(matrix), "embree", bare_rate, "Mray/s", false);
  book.versus(c.name() + "/flux_to_1_percent", to_one_percent(heat.seconds, heat_error.flux), "embree",
              to_one_percent(bare.seconds, bare_error.flux), "s", true);
  book.versus(c.name() + "/near_pairs_to_1_percent", to_one_percent(matrix.seconds, matrix_error.near),
              "embree", to_one_percent(bare.seconds, bare_error.near), "s", true);
  book.versus(c.name() + "/sobol_flux_to_1_percent", to_one_percent(sobol.seconds, sobol_error.flux),
              "embree", to_one_percent(bare.seconds, bare_error.flux), "s", true);
  book.versus(c.name() + "/matrix_memory", matrix.memory_MiB, "limit",
              static_cast<double>(LineOptions{}.memory_limit_bytes) / (1 << 20), "MiB", true);
}

/// The same rays, from the particles and in the order a trace sends them, followed by both tracers: rates of
/// the first hits alone and the number of rays they disagree on; then the rate of a whole trace, with the
/// making of its rays and the counting of its hits.
void per_ray(Book& book, const Case& c) {
  const auto rays = static_cast<std::int64_t>(std::max(8.0, 1e6 / static_cast<double>(c.count)));
  const BareEmbree bare(c.bed);
  const EmbreeTracer ours(c.bed, 1);
  const Emitter emitter(c.bed);
  std::vector<Emission> starts;
  std::vector<std::int32_t> from;
  const auto spheres = std::min<std::size_t>(c.count, 100000);
  for (std::size_t i = 0; i < spheres; ++i) {
    const auto surface = static_cast<std::int32_t>(i);
    const RaySampler sampler(Sampling::sobol, 1, surface, 0);
    for (std::int64_t k = 0; k < rays; ++k) {
      const auto u = sampler(static_cast<std::uint64_t>(k));
      starts.push_back(emitter.emit(surface, u[0], u[1], u[2], u[3]));
      from.push_back(surface);
    }
  }
  std::vector<std::int64_t> bare_end(starts.size()), our_end(starts.size());
  double bare_s = 1e300, our_s = 1e300, trace_s = 1e300, traced = 0;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const double start = cpu_s();
    for (std::size_t k = 0; k < starts.size(); ++k)
      bare_end[k] = bare.hit(static_cast<std::size_t>(from[k]), starts[k]);
    const double middle = cpu_s();
    for (std::size_t k = 0; k < starts.size(); ++k)
      our_end[k] = ours.first_end(starts[k].origin_m, starts[k].direction, from[k], starts[k].normal).surface;
    const double end = cpu_s();
    bare_s = std::min(bare_s, middle - start), our_s = std::min(our_s, end - middle);
    const Result whole = embree_sobol(c, static_cast<double>(rays), 1);
    trace_s = std::min(trace_s, whole.seconds), traced = whole.rays;
  }
  std::int64_t differ = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) differ += bare_end[k] != our_end[k];
  const double n = 1e-6 * static_cast<double>(starts.size());
  book.versus(c.name() + "/embree_per_ray", n / our_s, "embree", n / bare_s, "Mray/s", false);
  book.versus(c.name() + "/embree_whole_trace", 1e-6 * traced / trace_s, "embree", n / bare_s, "Mray/s",
              false);
  book.note(fmt::format("{}/embree_per_ray: {} of {} rays end elsewhere", c.name(), differ, starts.size()));
}

void two_threads(Book& book, const Case& c) {
  const int directions = directions_for(c.count, 2e7);
  double best[2] = {1e300, 1e300};
  for (int repeat = 0; repeat < 5; ++repeat)
    for (int threads = 1; threads <= 2; ++threads) {
      const double start = monotonic_s();
      sweep_black_heat(c.bed, hot_walls(c), line_options(directions, 1, threads));
      best[threads - 1] = std::min(best[threads - 1], monotonic_s() - start);
    }
  book.versus(c.name() + "/two_threads", best[1], "one_thread", best[0], "s", true);
}

int run(const std::string& folder, bool quick) {
  Book book(folder);
  const std::vector<std::size_t> counts = quick ? std::vector<std::size_t>{500, 3600}
                                                : std::vector<std::size_t>{500, 3600, 14000, 100000, 1000000};
  for (const double fraction : {0.07, 0.43, 0.57}) {
    Cost small{};
    for (const std::size_t count : counts) {
      const Case c = make_case(count, fraction);
      measure(book, c);
      per_ray(book, c);
      if (count == 3600) {
        two_threads(book, c);
        small = cost_per_particle(c);
      }
      if (count > 3600) compare_cost(book, c, cost_per_particle(c), small);
    }
  }
  book.finish();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string folder = ".";
  for (int k = 1; k < argc; ++k)
    if (!std::strcmp(argv[k], "--quick"))
      quick = true;
    else
      folder = argv[k];
  try {
    return run(folder, quick);
  } catch (const Error& error) {
    fmt::print(stderr, "trace_bench: {}\n", error.what());
    return error.exit_code();
  }
}
