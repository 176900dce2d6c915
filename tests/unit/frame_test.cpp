// A frame read back is the bed that was written, bit for bit; a damaged or foreign file is refused.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/random.h"
#include "dem/io/snapshot.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

class Frame : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

Bed random_bed(std::size_t n) {
  Bed bed;
  Material alumina;
  alumina.name = "alumina";
  alumina.density_kg_m3 = 3984;
  alumina.friction = 0.1 + 0.2;
  Material seed;
  seed.name = "mustard \u00e4";
  seed.emissivity = 0.7;
  bed.materials = {alumina, seed};
  bed.box = {{-0.005, -0.002, 0}, {0.005, 0.002, 0.05}};
  bed.periodic = {true, false, true};
  for (const auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  bed.walls[1].role = WallRole::excluded;
  bed.walls[1].contact = false;
  bed.walls[2].role = WallRole::isothermal;
  bed.walls[2].temperature_K = 1000.0 / 3;
  bed.walls[3].velocity_m_s = {0, 0.1, 0};
  bed.walls[4].opens_at_s = 1.5;
  Wall mesh;
  mesh.name = "hopper";
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  bed.walls.push_back(mesh);
  auto uniform = [k = std::uint64_t{0}]() mutable { return random_uniform2(7, 1, k++)[0]; };
  for (std::size_t i = 0; i < n; ++i) {
    bed.next_id += i % 3;  // gaps in the ids
    bed.add({uniform(), -uniform(), uniform() * 1e-300}, {uniform(), 0.0, -0.0}, uniform() + 1e-9,
            300 + uniform(), static_cast<std::int32_t>(i % 2));
    bed.angular_velocity_rad_s.back() = {uniform(), uniform(), 1 / 3.0};
    bed.radiative_heat_W.back() = -uniform();
    if (i > 0) bed.contacts.push_back({bed.id[i - 1], bed.id[i], {uniform() * 1e-9, 0, 0}});
  }
  if (n > 0) bed.contacts.push_back({bed.id[n - 1], -8, {0, 0, 1e-8}});
  bed.next_id += 5;
  bed.time_s = 0.1 + 0.2;
  bed.step = 123456789012;
  return bed;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same(const Bed& a, const Bed& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.next_id, b.next_id);
  EXPECT_TRUE(same_bits(a.id, b.id));
  EXPECT_TRUE(same_bits(a.position_m, b.position_m));
  EXPECT_TRUE(same_bits(a.velocity_m_s, b.velocity_m_s));
  EXPECT_TRUE(same_bits(a.angular_velocity_rad_s, b.angular_velocity_rad_s));
  EXPECT_TRUE(same_bits(a.radius_m, b.radius_m));
  EXPECT_TRUE(same_bits(a.temperature_K, b.temperature_K));
  EXPECT_TRUE(same_bits(a.radiative_heat_W, b.radiative_heat_W));
  EXPECT_TRUE(same_bits(a.material, b.material));
  EXPECT_TRUE(same_bits(a.contacts, b.contacts));
  EXPECT_EQ(a.periodic, b.periodic);
  EXPECT_EQ(a.box.min, b.box.min);
  EXPECT_EQ(a.box.max, b.box.max);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    EXPECT_EQ(a.materials[m].name, b.materials[m].name);
    EXPECT_EQ(a.materials[m].friction, b.materials[m].friction);
    EXPECT_EQ(a.materials[m].emissivity, b.materials[m].emissivity);
  }
  ASSERT_EQ(a.walls.size(), b.walls.size());
  for (std::size_t w = 0; w < a.walls.size(); ++w) {
    EXPECT_EQ(a.walls[w].name, b.walls[w].name);
    EXPECT_EQ(a.walls[w].vertices, b.walls[w].vertices);
    EXPECT_EQ(a.walls[w].triangles, b.walls[w].triangles);
    EXPECT_EQ(a.walls[w].role, b.walls[w].role);
    EXPECT_EQ(a.walls[w].temperature_K, b.walls[w].temperature_K);
    EXPECT_EQ(a.walls[w].emissivity, b.walls[w].emissivity);
    EXPECT_EQ(a.walls[w].contact, b.walls[w].contact);
    EXPECT_EQ(a.walls[w].velocity_m_s, b.walls[w].velocity_m_s);
    EXPECT_EQ(a.walls[w].opens_at_s, b.walls[w].opens_at_s);
  }
}

TEST_F(Frame, RoundTripIsBitwise) {
  StateBlocks state;
  state["feed"].integers["inserted"] = {1, -2, std::numeric_limits<std::int64_t>::max()};
  state["feed"].reals["mass"] = {0.1, -0.0, 5e-324, std::numeric_limits<double>::infinity()};
  state["empty"].reals["nothing"] = {};
  for (const std::size_t n : {0, 1, 2, 1000, 70000}) {
    const Bed bed = random_bed(n);
    const fs::path file = folder_ / "f.hdf";
    write_frame(file, bed, state, {{"h", std::vector<double>(n, 1.5)}});
    const Snapshot back = read_snapshot(file);
    expect_same(bed, back.bed);
    ASSERT_EQ(back.state.size(), 2u);
    EXPECT_EQ(back.state.at("feed").integers, state.at("feed").integers);
    EXPECT_TRUE(same_bits(back.state.at("feed").reals.at("mass"), state.at("feed").reals.at("mass")));
    EXPECT_TRUE(back.state.at("empty").reals.at("nothing").empty());
    EXPECT_EQ(back.origin, file.string());
    EXPECT_FALSE(fs::exists(file.string() + ".tmp"));
  }
}

TEST_F(Frame, HoldsTheVtkStructureViewersRead) {
  const Bed bed = random_bed(5);
  write_frame(folder_ / "f.hdf", bed, {}, {{"h", std::vector<double>(5, 1.5)}});
  const Hdf5Reader in(folder_ / "f.hdf");
  EXPECT_EQ(in.text_attribute("/VTKHDF", "Type"), "UnstructuredGrid");
  EXPECT_TRUE(in.has_attribute("/VTKHDF", "Version"));
  EXPECT_FALSE(in.has("/VTKHDF/Steps")) << "temporal files are misread by common viewers";
  for (const char* count : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    EXPECT_EQ(in.read<std::int64_t>(std::string("/VTKHDF/") + count), std::vector<std::int64_t>{5});
  EXPECT_EQ(in.read<std::int64_t>("/VTKHDF/Offsets"), (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(in.read<std::int64_t>("/VTKHDF/Connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(in.read<std::uint8_t>("/VTKHDF/Types"), std::vector<std::uint8_t>(5, 1));
  EXPECT_EQ(in.read<double>("/VTKHDF/Points", 3).size(), 15u);
  for (const char* name :
       {"id", "radius", "temperature", "v", "omega", "q_rad", "q_ss", "q_sfs", "material", "h"})
    EXPECT_TRUE(in.has(std::string("/VTKHDF/PointData/") + name)) << name;
  EXPECT_FALSE(in.text_attribute("/granrad", "git_sha").empty());
}

std::string read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(Frame, TruncatedOrDamagedFilesAreRefused) {
  const fs::path good = folder_ / "good.hdf", bad = folder_ / "bad.hdf";
  const std::size_t n = 2000;
  write_frame(good, random_bed(n), {});
  const std::string bytes = read_bytes(good);
  for (const double part : {0.0, 0.001, 0.1, 0.5, 0.9, 0.999}) {
    std::ofstream(bad, std::ios::binary) << bytes.substr(0, static_cast<std::size_t>(part * bytes.size()));
    EXPECT_THROW(read_snapshot(bad), Error) << part;
  }
  // A flipped bit is either noticed (checksums of data and metadata) or stands in unused space: never a
  // crash, never another bed.
  const Bed bed = read_frame(good).bed;
  int noticed = 0;
  const int trials = 150;
  for (int k = 0; k < trials; ++k) {
    std::string damaged = bytes;
    const auto at = random_bits(11, 0, k)[0] % bytes.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (k % 8)));
    std::ofstream(bad, std::ios::binary) << damaged;
    try {
      expect_same(read_frame(bad).bed, bed);
    } catch (const Error&) {
      ++noticed;
    }
    if (HasFailure()) FAIL() << "byte " << at << " of " << bytes.size();
  }
  // At least the flips in the uncompressed columns are noticed: 9 + 3 numbers per particle and 3 per contact;
  // 4 sigma.
  const double share = n * 15 * sizeof(double) / static_cast<double>(bytes.size());
  EXPECT_GT(share, 0.5);
  EXPECT_GE(noticed, trials * share - 4 * std::sqrt(trials * share * (1 - share)));
}

TEST_F(Frame, ForeignFilesAreRefused) {
  EXPECT_THROW(read_frame(folder_ / "none.hdf"), IoError);
  std::ofstream(folder_ / "text.hdf") << "x,y,z,radius\n";
  EXPECT_THROW(read_snapshot(folder_ / "text.hdf"), IoError);
  {
    Hdf5Writer other(folder_ / "other.hdf");
    other.write("/a", std::vector<double>{1});
    other.commit();
  }
  EXPECT_THROW(read_snapshot(folder_ / "other.hdf"), InputError);
}

TEST_F(Frame, NothingIsWrittenOfAStateThatIsNotFinite) {
  Bed bed = random_bed(3);
  bed.temperature_K[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_frame(folder_ / "f.hdf", bed, {}), NumericalError);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  EXPECT_THROW(write_frame(folder_.path() / "missing" / "f.hdf", random_bed(3), {}), IoError);
}

/// The process that wrote to a disk that was full ends as it wants to. Planted and caught: without H5dont_atexit it
/// ends in the library's cleanup, by SIGSEGV.
TEST_F(Frame, AFullDiskIsAnErrorAndNoCrash) {
  const auto write_with_little_room = [&] {
    constexpr rlim_t room = 40000;
    const rlimit limit{room, room};
    std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_frame(folder_ / "f.hdf", random_bed(20000), {});
    } catch (const IoError&) {
      std::exit(3);
    }
    std::exit(0);
  };
  EXPECT_EXIT(write_with_little_room(), testing::ExitedWithCode(3), "");
  EXPECT_FALSE(fs::exists(folder_ / "f.hdf"));
}

TEST_F(Frame, ACrashedWriteLeavesTheOldFrame) {
  const fs::path file = folder_ / "f.hdf";
  write_frame(file, random_bed(3), {});
  { Hdf5Writer abandoned(file); }
  EXPECT_EQ(read_frame(file).bed.size(), 3u);
  EXPECT_FALSE(fs::exists(file.string() + ".tmp"));
}

TEST_F(Frame, SeriesNamesFramesRelativeToItself) {
  fs::create_directories(folder_ / "frames");
  write_series(folder_ / "run.hdf.series",
               {{folder_ / "frames/f_0.hdf", 0.0}, {folder_ / "frames/f_1.hdf", 0.25}});
  const std::string text = read_bytes(folder_ / "run.hdf.series");
  EXPECT_NE(text.find("\"file-series-version\": \"1.0\""), text.npos) << text;
  EXPECT_NE(text.find("\"name\": \"frames/f_1.hdf\""), text.npos) << text;
  EXPECT_NE(text.find("\"time\": 0.25"), text.npos) << text;
}

}  // namespace
}  // namespace granrad
