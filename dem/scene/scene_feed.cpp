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

/// particle_count, or as many particles as make up mass_kg.
void read_hopper_count(TomlTable& feed, Scene& scene) {
  const double d = scene.particle_diameter_m;
  const double particle_mass = pi / 6 * d * d * d * scene.materials[0].density_kg_m3;
  const auto mass = feed.optional_number({"mass_kg", "mass to fill in, instead of particle_count"},
                                         {.unit = "kg", .min = 0, .min_exclusive = true});
  if (!mass) {
    scene.feed.particle_count = feed.integer({"particle_count", "particles to fill in", "from mass_kg"}, 1,
                                             std::numeric_limits<std::int32_t>::max());
    return;
  }
  const std::int64_t from_mass = particle_mass > 0 ? std::llround(*mass / particle_mass) : 0;
  scene.feed.particle_count = feed.integer({"particle_count", "particles to fill in", "from mass_kg"}, 1,
                                           std::numeric_limits<std::int32_t>::max(), from_mass);
  if (std::abs(static_cast<double>(scene.feed.particle_count - from_mass)) >
      redundancy_tolerance * static_cast<double>(from_mass))
    feed.problem("particle_count",
                 fmt::format("mass_kg gives {} particles; leave one of the two out", from_mass));
}

void read_hopper(TomlTable& feed, Scene& scene) {
  read_hopper_count(feed, scene);
  TomlTable fill = feed.table({"fill_region", "Where a hopper is filled"});
  FeedSettings& out = scene.feed;
  out.fill_region.min = fill.vec3({"min_m", "lower corner"}, {.unit = "m"});
  out.fill_region.max = fill.vec3({"max_m", "upper corner"}, {.unit = "m"});
  const Vec3 size = out.fill_region.size();
  const double d = scene.particle_diameter_m;
  if (fill.has("min_m") && fill.has("max_m") && !(size.x >= d && size.y >= d && size.z >= d))
    fill.problem("max_m",
                 "the fill region must hold a particle: max_m - min_m >= the diameter in every direction");
  out.refill = feed.boolean({"refill", "particles that leave enter again at the top"}, true);
  out.mass_flow_kg_s =
      feed.number({"mass_flow_kg_s", "mass that enters per time; a hopper without it fills at once",
                   "follows from the two others, or 0"},
                  {.unit = "kg/s", .min = 0, .min_exclusive = true}, 0.0);
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
