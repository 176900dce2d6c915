#include "dem/mesh/winding.h"

#include <algorithm>
#include <map>
#include <utility>

namespace granrad {

namespace {

/// A triangle that runs along an edge from its lower to its higher vertex, or back.
struct EdgeUse {
  std::size_t triangle;
  bool forward;
};

/// Neighbours over one edge; `alike`: they face the same side as they are.
struct Neighbour {
  std::size_t triangle;
  bool alike;
};

std::vector<std::vector<Neighbour>> neighbours_of(const std::vector<Triangle*>& triangles) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<EdgeUse>> uses;
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t a = (*triangles[k])[c], b = (*triangles[k])[(c + 1) % 3];
      uses[std::minmax(a, b)].push_back({k, a < b});
    }
  std::vector<std::vector<Neighbour>> neighbours(triangles.size());
  for (const auto& [edge, at] : uses) {
    if (at.size() != 2) continue;
    const bool alike = at[0].forward != at[1].forward;
    neighbours[at[0].triangle].push_back({at[1].triangle, alike});
    neighbours[at[1].triangle].push_back({at[0].triangle, alike});
  }
  return neighbours;
}

/// The part of a mesh that hangs together with `first`: its triangles, and which of them face the other side.
struct Part {
  std::vector<std::size_t> triangles;
  std::size_t turned = 0;
  bool has_two_sides = true;
};

/// `side`: 0 not seen yet, 1 as `first`, -1 the other.
Part part_of(std::size_t first, const std::vector<std::vector<Neighbour>>& neighbours,
             std::vector<int>& side) {
  Part part{{first}};
  side[first] = 1;
  for (std::size_t k = 0; k < part.triangles.size(); ++k) {
    const std::size_t here = part.triangles[k];
    part.turned += side[here] < 0;
    for (const auto& next : neighbours[here]) {
      const int wanted = next.alike ? side[here] : -side[here];
      if (side[next.triangle] == 0) {
        side[next.triangle] = wanted;
        part.triangles.push_back(next.triangle);
      } else if (side[next.triangle] != wanted) {
        part.has_two_sides = false;
      }
    }
  }
  return part;
}

}  // namespace

std::size_t wind_alike(std::vector<std::vector<Triangle>>& meshes) {
  std::vector<Triangle*> triangles;
  for (auto& mesh : meshes)
    for (auto& t : mesh) triangles.push_back(&t);
  const auto neighbours = neighbours_of(triangles);
  std::vector<int> side(triangles.size(), 0);
  std::size_t turned = 0;
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (side[first] != 0) continue;
    const Part part = part_of(first, neighbours, side);
    if (!part.has_two_sides) continue;
    const int minority = 2 * part.turned > part.triangles.size() ? 1 : -1;
    for (const std::size_t k : part.triangles)
      if (side[k] == minority) {
        std::swap((*triangles[k])[1], (*triangles[k])[2]);
        ++turned;
      }
  }
  return turned;
}

}  // namespace granrad
