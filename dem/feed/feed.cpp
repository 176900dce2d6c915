#include "dem/feed/feed.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "dem/base/constants.h"
#include "dem/feed/hopper_feed.h"
#include "dem/feed/plug_feed.h"
#include "dem/io/saved_state.h"

BOOST_HANA_ADAPT_STRUCT(granrad::FeedTotals, mass_in_kg, mass_out_kg, heat_in_J, heat_out_J,
                        heat_capacity_out_J_K, inserted, removed, nudged, waiting);

namespace granrad {

namespace {

/// A scene without a feed: nothing comes, nothing goes.
struct NoFeed {
  void start(Bed&) {}
  double leaves_below_m() const { return -infinity; }
  void insert_due(Bed&, FeedTotals&) {}
  void save(StateBlock&) const {}
  void load(const StateBlock&) {}
};

using AnyFeed = std::variant<NoFeed, PlugFeed, HopperFeed>;

AnyFeed make_feed(const Scene& scene) {
  switch (scene.feed.kind) {
    case FeedSettings::Kind::plug:
      return AnyFeed(std::in_place_type<PlugFeed>, scene);
    case FeedSettings::Kind::hopper:
      return AnyFeed(std::in_place_type<HopperFeed>, scene);
    case FeedSettings::Kind::none:
      break;
  }
  return NoFeed{};
}

double heat_capacity_J_K(const Bed& bed, std::size_t i) {
  return mass_kg(bed, i) * bed.materials[bed.material[i]].specific_heat_J_kgK;
}

/// Takes out the particles whose centre is below z or in one of the boxes.
void remove(double z, const std::vector<Box>& boxes, Bed& bed, FeedTotals& totals) {
  std::vector<char> keep(bed.size(), 1);
  const auto removed_before = totals.removed;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Vec3 place = wrapped_into_box(bed, bed.position_m[i]);
    const bool leaves = place.z < z || std::any_of(boxes.begin(), boxes.end(),
                                                   [&](const Box& box) { return box.contains(place); });
    if (!leaves) continue;
    keep[i] = 0;
    totals.mass_out_kg += mass_kg(bed, i);
    totals.heat_capacity_out_J_K += heat_capacity_J_K(bed, i);
    totals.heat_out_J += heat_capacity_J_K(bed, i) * bed.temperature_K[i];
    ++totals.removed;
  }
  if (totals.removed > removed_before) bed.remove_unless(keep);
}

void count_inserted(const Bed& bed, std::size_t first_new, FeedTotals& totals) {
  for (std::size_t i = first_new; i < bed.size(); ++i) {
    totals.mass_in_kg += mass_kg(bed, i);
    totals.heat_in_J += heat_capacity_J_K(bed, i) * bed.temperature_K[i];
    ++totals.inserted;
  }
}

}  // namespace

struct Feed::Impl {
  bool frozen;
  AnyFeed feed;
  std::vector<Box> removals;
  FeedTotals totals;
};

Feed::Feed(const Scene& scene)
    : impl_(std::make_unique<Impl>(
          Impl{scene.engine == EngineKind::none, make_feed(scene), scene.removals, {}})) {}
Feed::~Feed() = default;
Feed::Feed(Feed&&) noexcept = default;
Feed& Feed::operator=(Feed&&) noexcept = default;

void Feed::start(Bed& bed) {
  std::visit([&](auto& feed) { feed.start(bed); }, impl_->feed);
}

void Feed::update(Bed& bed) {
  if (impl_->frozen) return;
  const auto step = [&](auto& feed) {
    remove(feed.leaves_below_m(), impl_->removals, bed, impl_->totals);
    const auto first_new = bed.size();
    feed.insert_due(bed, impl_->totals);
    count_inserted(bed, first_new, impl_->totals);
  };
  std::visit(step, impl_->feed);
}

const FeedTotals& Feed::totals() const {
  return impl_->totals;
}

StateBlock Feed::save() const {
  StateBlock state;
  save_values(impl_->totals, state);
  std::visit([&](const auto& feed) { feed.save(state); }, impl_->feed);
  return state;
}

void Feed::load(const StateBlock& state) {
  restore_values(impl_->totals, state);
  std::visit([&](auto& feed) { feed.load(state); }, impl_->feed);
}

}  // namespace granrad
