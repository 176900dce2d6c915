#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "dem/base/constants.h"
#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

/// Largest relative difference between quantities that are given although they follow from each other.
constexpr double redundancy_tolerance = 0.01;
/// Random close packing of equal spheres.
constexpr double densest_random_packing = 0.64;

/// Two of solid fraction, mass flow and speed give the third: m = rho phi A v.
void read_plug_flow(TomlTable& feed, Scene& scene) {
  const auto phi = feed.optional_number(
      {"solid_fraction", "volume of particles per volume of the channel, held by the plug"},
      {.min = 0,
       .max = densest_random_packing,
       .min_exclusive = true,
       .max_exclusive = true,
       .why = "spheres cannot be packed denser at random"});
  const auto flow =
      feed.optional_number({"mass_flow_kg_s", "mass that enters per time; a hopper without it fills at once",
                            "follows from the two others, or 0"},
                           {.unit = "kg/s", .min = 0, .min_exclusive = true});
  const auto speed = feed.optional_number(
      {"velocity_m_s", "speed at which particles enter", "follows from the two others, or 0"},
      {.unit = "m/s", .min = 0, .min_exclusive = true});
  const double density_area = scene.materials[0].density_kg_m3 * scene.box.size().x * scene.box.size().y;
  FeedSettings& out = scene.feed;
  if (phi.has_value() + flow.has_value() + speed.has_value() < 2) {
    feed.problem("",
                 "a plug needs two of solid_fraction, mass_flow_kg_s and velocity_m_s; the third follows");
    return;
  }
  out.solid_fraction = phi ? *phi : *flow / (density_area * *speed);
  out.velocity_m_s = speed ? *speed : *flow / (density_area * *phi);
  out.mass_flow_kg_s = flow ? *flow : density_area * *phi * *speed;
  const double implied = density_area * out.solid_fraction * out.velocity_m_s;
  if (std::abs(implied - out.mass_flow_kg_s) > redundancy_tolerance * implied)
    feed.problem(
        "mass_flow_kg_s",
        fmt::format("solid_fraction and velocity_m_s give {:.4g} kg/s; leave one of the three out", implied));
  if (!phi && out.solid_fraction >= densest_random_packing)
    feed.problem("mass_flow_kg_s",
                 fmt::format("needs a solid fraction of {:.3g} at this speed, which cannot be packed; "
                             "raise velocity_m_s",
                             out.solid_fraction));
}

void read_plug(TomlTable& feed, Scene& scene) {
  read_plug_flow(feed, scene);
  scene.feed.transverse_velocity_std_m_s =
      feed.number({"transverse_velocity_std_m_s", "standard deviation of the velocity across the flow"},
                  {.unit = "m/s", .min = 0}, 0.0);
  scene.feed.start_filled = feed.boolean({"start_filled", "the channel is full at time 0"}, true);
}

/// particle_count, or as many particles as make up mass_kg; without limit when they are poured at a rate.
void read_hopper_count(TomlTable& feed, Scene& scene, double particle_mass_kg) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  const Key count_key{"particle_count", "particles kept in the system; with a rate, poured in all"};
  const auto mass = feed.optional_number({"mass_kg", "instead of particle_count: their mass"},
                                         {.unit = "kg", .min = 0, .min_exclusive = true});
  if (!mass) {
    if (scene.feed.rate_1_s > 0)
      scene.feed.particle_count = feed.integer(count_key, 1, most, most);
    else
      scene.feed.particle_count = feed.integer(count_key, 1, most);
    return;
  }
  const double wanted = particle_mass_kg > 0 ? *mass / particle_mass_kg : 0;
  if (wanted > static_cast<double>(most)) {
    feed.problem("mass_kg", fmt::format("makes {:.3g} particles, more than {}; give less", wanted, most));
    return;
  }
  const std::int64_t from_mass = std::llround(wanted);
  scene.feed.particle_count = feed.integer(count_key, 1, most, std::max<std::int64_t>(1, from_mass));
  if (std::abs(static_cast<double>(scene.feed.particle_count - from_mass)) >
      redundancy_tolerance * static_cast<double>(from_mass))
    feed.problem("particle_count",
                 fmt::format("mass_kg gives {} particles; leave one of the two out", from_mass));
}

/// Poured from the start at rate_1_s or rate_kg_s; a batch (refill = false) with a mass flow likewise.
void read_hopper_rate(TomlTable& feed, Scene& scene, double particle_mass_kg) {
  FeedSettings& out = scene.feed;
  const NumberRule per_second{.unit = "1/s", .min = 0, .min_exclusive = true},
      mass_per_second{.unit = "kg/s", .min = 0, .min_exclusive = true};
  out.refill = feed.boolean({"refill", "what left comes back cold at the top; false: one batch"}, true);
  out.mass_flow_kg_s = feed.number(
      {"mass_flow_kg_s", "refill at most this fast; with refill = false the batch is poured at this rate",
       "no limit"},
      mass_per_second, 0.0);
  const auto number =
      feed.optional_number({"rate_1_s", "particles poured per second, from the start"}, per_second);
  const auto mass =
      feed.optional_number({"rate_kg_s", "mass poured per second, from the start"}, mass_per_second);
  if (number.has_value() + mass.has_value() + feed.has("mass_flow_kg_s") > 1)
    feed.problem(
        mass ? "rate_kg_s" : "rate_1_s",
        "only one of rate_1_s, rate_kg_s and mass_flow_kg_s says how fast particles come; leave the others out");
  const double kg_s = mass ? *mass : out.refill ? 0 : out.mass_flow_kg_s;
  out.rate_1_s = number ? *number : particle_mass_kg > 0 ? kg_s / particle_mass_kg : 0;
  if (out.rate_1_s > 0) out.mass_flow_kg_s = 0;
}

void read_hopper(TomlTable& feed, Scene& scene) {
  const double d = scene.particle_diameter_m;
  const double particle_mass_kg = pi / 6 * d * d * d * scene.materials[0].density_kg_m3;
  read_hopper_rate(feed, scene, particle_mass_kg);
  read_hopper_count(feed, scene, particle_mass_kg);
  TomlTable fill = feed.table({"fill_region", "Where a hopper is filled"});
  FeedSettings& out = scene.feed;
  out.fill_region.min = fill.vec3({"min_m", "lower corner"}, {.unit = "m"});
  out.fill_region.max = fill.vec3({"max_m", "upper corner"}, {.unit = "m"});
  const Vec3 size = out.fill_region.size();
  if (fill.has("min_m") && fill.has("max_m") && !(size.x >= d && size.y >= d && size.z >= d))
    fill.problem("max_m",
                 "the fill region must hold a particle: max_m - min_m >= the diameter in every direction");
  out.velocity_m_s =
      feed.number({"velocity_m_s", "speed at which particles enter", "follows from the two others, or 0"},
                  {.unit = "m/s", .min = 0}, 0.0);
  out.remove_below_m =
      feed.number({"remove_below_m", "height below which particles have left", "bottom of the box"},
                  {.unit = "m"}, scene.box.min.z);
}

}  // namespace

FeedSettings::Kind read_feed_kind(TomlTable feed) {
  if (!feed.present()) return FeedSettings::Kind::none;
  const std::string kind = feed.choice(
      {"kind", "plug: a flow of held solid fraction along z; hopper: filled from above"}, {"plug", "hopper"});
  return kind == "plug" ? FeedSettings::Kind::plug : FeedSettings::Kind::hopper;
}

void read_feed(TomlTable feed, Scene& scene) {
  if (!feed.present()) return;
  scene.feed.seed =
      static_cast<std::uint64_t>(feed.integer({"seed", "of the random numbers that place particles"}, 0,
                                              std::numeric_limits<std::int64_t>::max(), 1));
  if (scene.feed.kind == FeedSettings::Kind::plug)
    read_plug(feed, scene);
  else
    read_hopper(feed, scene);
}

}  // namespace granrad
