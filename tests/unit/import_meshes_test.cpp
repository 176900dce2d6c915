// Meshes come in as CAD writes them: corners that nearly meet, facets twice, corners on edges, solids of one name.
#include "dem/mesh/import_stl.h"
#include "tests/unit/import_fixture.h"

namespace granrad {
namespace {

std::string facet(const Vec3& a, const Vec3& b, const Vec3& c) {
  std::string text = "facet normal 0 0 0\nouter loop\n";
  for (const Vec3& v : {a, b, c})
    text += "vertex " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  return text + "endloop\nendfacet\n";
}

TEST_F(ImportFormats, MeshesAreMended) {
  // a unit square of two triangles, their shared corners 3e-6 apart, one triangle twice, one without area
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, near_a{3e-6, 0, 0}, near_c{1, 1, -3e-6};
  std::string note;
  const auto walls =
      import_stl(folder_.write("square.stl", "solid square\n" + facet(a, b, c) + facet(near_a, near_c, d) +
                                                 facet(b, c, a) + facet(a, b, near_a) + "endsolid square\n"),
                 1, "wall", &note);
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(walls[0].vertices, (std::vector<Vec3>{a, b, c, d}));
  EXPECT_EQ(walls[0].triangles, (std::vector<std::array<std::int32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  expect_says(note, "3 corners within 1.4e-05 m");
  expect_says(note, "1 triangles without area left out, 1 triangles given twice left out");
  const auto both =
      import_stl(folder_.write("sheet.stl", "solid s\n" + facet(a, b, c) + facet(a, c, b) + "endsolid s\n"),
                 1, "w", &note);
  EXPECT_EQ(both[0].triangles.size(), 2u) << "the two sides of a sheet are no double";
  EXPECT_EQ(note, "");
}

TEST_F(ImportFormats, ACornerOnAnEdgeCutsTheTriangle) {
  // one large triangle beside two small ones that share its edge a-b: edges meet edges after it
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, m{0.4, 0, 0}, up{0.5, 1, 0}, down{0.5, -1, 0};
  std::string note;
  const auto walls = import_stl(folder_.write("t.stl", "solid t\n" + facet(a, b, up) + facet(b, m, down) +
                                                           facet(m, a, down) + "endsolid t\n"),
                                1, "wall", &note);
  std::map<std::pair<int, int>, int> uses;
  double area_m2 = 0;
  for (const auto& t : walls[0].triangles) {
    const auto& v = walls[0].vertices;
    area_m2 += 0.5 * cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]).z;
    for (int k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  }
  EXPECT_EQ(walls[0].triangles.size(), 4u);
  EXPECT_NEAR(area_m2, 1, 1e-15);
  EXPECT_EQ(std::count_if(uses.begin(), uses.end(), [](const auto& edge) { return edge.second == 1; }), 4)
      << "the rim alone is open";
  expect_says(note, "1 triangles cut at corners on their edges");
}

TEST_F(ImportFormats, SolidsKeepTheirWholeNamesAndDiffer) {
  const std::string any = facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                    other = facet({0, 0, 1}, {1, 0, 1}, {0, 1, 1});
  const auto walls = import_stl(
      folder_.write("n.stl", "solid hopper z0\n" + any + "endsolid\nsolid hopper z1\n" + other +
                                 "endsolid\nsolid hopper z1\n" + facet({0, 0, 2}, {1, 0, 2}, {0, 1, 2}) +
                                 "endsolid\nsolid\n" + facet({0, 0, 3}, {1, 0, 3}, {0, 1, 3}) + "endsolid\n"),
      1, "w");
  std::vector<std::string> names;
  for (const auto& wall : walls) names.push_back(wall.name);
  EXPECT_EQ(names, (std::vector<std::string>{"w.hopper z0", "w.hopper z1", "w.hopper z1_2", "w.4"}));
}

}  // namespace
}  // namespace granrad
