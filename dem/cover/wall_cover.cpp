#include "dem/cover/wall_cover.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "dem/base/error.h"
#include "dem/bed/planar_cut.h"
#include "dem/bed/wall_shape.h"
#include "dem/cover/laid_plates.h"

namespace granrad {

namespace {

/// Places closer than this part of the extent of all walls are one.
constexpr double same_place = 2e-7;

/// A face and what is left of it.
struct Faced {
  std::size_t wall;
  WallFace whole;
  std::vector<std::vector<Vec3>> pieces;
  bool changed = false;
};

/// Every edge of its triangles belongs to two of them.
bool is_closed(const Wall& wall) {
  if (wall.triangles.size() < 4) return false;
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const auto& t : wall.triangles)
    for (int c = 0; c < 3; ++c) ++uses[std::minmax(t[c], t[(c + 1) % 3])];
  return std::all_of(uses.begin(), uses.end(), [](const auto& edge) { return edge.second == 2; });
}

double slack_of(const std::vector<Wall>& walls) {
  Box all = Box::empty();
  for (const auto& wall : walls)
    for (const auto& v : wall.vertices) all.include(v);
  return all.is_empty() ? 0 : same_place * norm(all.size());
}

std::vector<std::size_t> by_age(std::size_t walls, const std::vector<std::int64_t>& order) {
  std::vector<std::size_t> sorted(walls);
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  if (!order.empty())
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](std::size_t a, std::size_t b) { return order[a] < order[b]; });
  return sorted;
}

class Cover {
 public:
  Cover(std::vector<Wall>& walls, const std::vector<std::size_t>& by_age, std::vector<char> feet,
        double slack_m)
      : walls_(walls), foot_(std::move(feet)), slack_m_(slack_m) {
    for (const auto& wall : walls_) closed_.push_back(is_closed(wall));
    for (const auto w : by_age)
      if (walls_[w].vertices.size() >= 3)
        for (auto& face : faces_of(walls_[w])) {
          std::vector<std::vector<Vec3>> pieces{face.vertices};
          faces_.push_back({w, std::move(face), std::move(pieces)});
        }
  }

  WallCover run() {
    visit_meetings();
    if (!problems_.empty()) throw InputError(problems_);
    insert_corners();
    return rebuild();
  }

 private:
  /// Every two faces whose boxes meet, the earlier first.
  void visit_meetings() {
    std::vector<std::size_t> sorted;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (is_finite(faces_[f].whole.normal)) sorted.push_back(f);
    const auto low = [&](std::size_t f) { return faces_[f].whole.bounds.min.x; };
    std::sort(sorted.begin(), sorted.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(low(a), a) < std::pair(low(b), b); });
    std::vector<std::size_t> open;
    std::vector<std::pair<std::size_t, std::size_t>> meetings;
    for (const auto f : sorted) {
      std::erase_if(open, [&](std::size_t g) { return faces_[g].whole.bounds.max.x + slack_m_ < low(f); });
      for (const auto g : open)
        if (faces_[f].whole.bounds.meets(faces_[g].whole.bounds, slack_m_) && are_coplanar(f, g))
          meetings.emplace_back(std::min(f, g), std::max(f, g));
      open.push_back(f);
    }
    std::sort(meetings.begin(), meetings.end());
    for (const auto& [earlier, later] : meetings) meet(earlier, later);
  }

  /// By the corners of the smaller face over the plane of the larger.
  bool are_coplanar(std::size_t f, std::size_t g) const {
    const WallFace *large = &faces_[f].whole, *small = &faces_[g].whole;
    if (std::abs(dot(large->normal, small->normal)) < nearly_parallel) return false;
    if (norm(small->bounds.size()) > norm(large->bounds.size())) std::swap(large, small);
    return std::all_of(small->vertices.begin(), small->vertices.end(), [&](const Vec3& v) {
      return std::abs(dot(large->normal, v - large->vertices[0])) <= slack_m_;
    });
  }

  void meet(std::size_t earlier, std::size_t later) {
    const Faced &a = faces_[earlier], &b = faces_[later];
    if (dot(a.whole.normal, b.whole.normal) > 0) {
      if (a.wall != b.wall && face_count(walls_[a.wall]) == 1 && face_count(walls_[b.wall]) == 1)
        zones_.insert(zones_.end(), {earlier, later});
      cut(earlier, later);
    } else if (a.wall != b.wall && (stands_on(b.wall, a.whole) || stands_on(a.wall, b.whole))) {
      if (cut(earlier, later, true)) cut(later, earlier, true);
    }
  }

  /// Whether a wall is a closed body and all of it on the front side of a face's plane, or the foot of one.
  bool stands_on(std::size_t wall, const WallFace& face) const {
    if (foot_[wall]) return true;
    if (!closed_[wall]) return false;
    const auto& v = walls_[wall].vertices;
    return std::all_of(v.begin(), v.end(),
                       [&](const Vec3& p) { return dot(face.normal, p - face.vertices[0]) >= -slack_m_; });
  }

  /// Takes out of face `under` what face `over` covers; whether that is anything. `hidden`: neither is touched there.
  bool cut(std::size_t under, std::size_t over, bool hidden = false) {
    Faced& a = faces_[under];
    const WallFace& cover = faces_[over].whole;
    std::vector<std::vector<Vec3>> left;
    double before = 0, after = 0;
    for (const auto& piece : a.pieces) {
      before += polygon_area(piece);
      for (auto& rest : difference(piece, cover, a.whole.normal, slack_m_, 4 * slack_m_)) {
        after += polygon_area(rest);
        left.push_back(std::move(rest));
      }
    }
    if (after == before || !may_cover(walls_[a.wall], walls_[faces_[over].wall], hidden)) return false;
    a.pieces = std::move(left);
    a.changed = true;
    covered_m2_[{faces_[over].wall, a.wall}] += before - after;
    covering_.insert(over);
    return true;
  }

  bool may_cover(const Wall& a, const Wall& b, bool hidden) {
    const bool touch_alike = hidden || a.contact == b.contact;
    if (touch_alike && a.opens_at_s == b.opens_at_s) return true;
    const char* what = !touch_alike ? "contact" : "opens_at_s";
    const auto problem =
        advised(fmt::format("wall {} lies on wall {}, and they differ in {} (one surface cannot have both)",
                            b.name, a.name, what),
                "give both the same, or leave a hole where the other one lies");
    if (std::find(problems_.begin(), problems_.end(), problem) == problems_.end())
      problems_.push_back(problem);
    return false;
  }

  /// Corners of what was cut, of what cut it, and of zones side by side, on the edges of all faces.
  void insert_corners() {
    std::vector<Vec3> corners;
    const auto take = [&](const std::vector<Vec3>& v) { corners.insert(corners.end(), v.begin(), v.end()); };
    for (const auto f : covering_) take(faces_[f].whole.vertices);
    for (const auto f : zones_) take(faces_[f].whole.vertices);
    CornerSet known(slack_m_);
    if (corners.empty()) return;
    for (const auto& p : corners) known.add(p);
    for (auto& face : faces_)
      if (face.changed)
        for (auto& piece : face.pieces)
          for (auto& v : piece) v = known.add(v);
    known.sort();
    for (auto& face : faces_)
      for (auto& piece : face.pieces) face.changed |= known.insert_into(piece);
  }

  template <class IsGone>
  void write_notes(IsGone is_gone, std::vector<std::string>& notes) const {
    for (const auto& [who, area_m2] : covered_m2_) {
      const auto [cover, under] = who;
      if (cover == under)
        notes.push_back(fmt::format("wall {} lies on itself over {:.4g} m2, which counts once",
                                    walls_[cover].name, area_m2));
      else if (!is_gone(under))
        notes.push_back(fmt::format("wall {} covers {:.4g} m2 of wall {}", walls_[cover].name, area_m2,
                                    walls_[under].name));
    }
    std::string gone;
    for (std::size_t w = 0; w < walls_.size(); ++w)
      if (is_gone(w)) gone += (gone.empty() ? "" : ", ") + walls_[w].name;
    if (!gone.empty()) notes.push_back(fmt::format("covered altogether and left out: {}", gone));
  }

  WallCover rebuild() {
    WallCover result;
    std::vector<std::vector<WallFace>> left(walls_.size());
    std::vector<char> changed(walls_.size(), 0);
    for (const auto& face : faces_) changed[face.wall] |= face.changed;
    for (const auto& face : faces_)
      if (changed[face.wall])
        for (const auto& piece : face.pieces) left[face.wall].push_back(make_face(piece));
    const auto is_gone = [&](std::size_t w) { return changed[w] && left[w].empty(); };
    write_notes(is_gone, result.notes);
    std::vector<Wall> kept;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
      if (is_gone(w)) continue;
      if (changed[w]) set_faces(walls_[w], left[w]);
      kept.push_back(std::move(walls_[w]));
      result.kept.push_back(w);
    }
    walls_ = std::move(kept);
    return result;
  }

  std::vector<Wall>& walls_;
  std::vector<char> closed_, foot_;  ///< by wall: a body; what a body of plates stands on
  double slack_m_ = 0;
  std::vector<Faced> faces_;  ///< in the order in which they were given
  std::map<std::pair<std::size_t, std::size_t>, double> covered_m2_;
  std::set<std::size_t> covering_;  ///< faces
  std::vector<std::size_t> zones_;  ///< faces side by side
  std::vector<std::string> problems_;
};

}  // namespace

WallCover cover_walls(std::vector<Wall>& walls, const std::vector<std::int64_t>& order) {
  const double slack_m = slack_of(walls);
  const auto sorted = by_age(walls.size(), order);
  LaidPlates laid = lay_plates(walls, sorted, slack_m);
  WallCover cover = Cover(walls, sorted, std::move(laid.is_foot), slack_m).run();
  cover.notes.insert(cover.notes.begin(), laid.notes.begin(), laid.notes.end());
  return cover;
}

}  // namespace granrad
