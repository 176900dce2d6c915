// HDF5 files whose content may be anything are refused with a reason, before an index, a length or an offset of
// theirs is used: view-factor files byte by byte and set by set, and the variable-length texts of older files.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/files/text_file.h"
#include "dem/base/random.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/enclosures.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

ViewFactorFile traced() {
  ViewFactorFile content;
  content.enclosure =
      boxed(spheres_in_open_space({{0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}}, {0.2, 0.2}), {{0, 0, 0}, {1, 1, 1}});
  TraceOptions options;
  options.rays_per_particle = 500;
  options.threads = 1;
  content.counts = trace_view_factors(content.enclosure, options);
  ClosureReport report;
  content.closed = close(one_way_estimate(content.counts), content.closure, report);
  content.origin = "a test";
  return content;
}

class DamagedHdf5 : public testing::Test {
 protected:
  DamagedHdf5() { write_view_factors(good_, content_); }
  TemporaryFolder folder_;
  ViewFactorFile content_ = traced();
  fs::path good_ = folder_ / "good.h5", bad_ = folder_ / "bad.h5";
};

TEST_F(DamagedHdf5, ViewFactorsComeBack) {
  const ViewFactorFile back = read_view_factors(good_);
  EXPECT_EQ(back.counts.hits, content_.counts.hits);
  EXPECT_EQ(back.counts.pattern.column, content_.counts.pattern.column);
  EXPECT_EQ(back.enclosure.walls.size(), 6u);
  EXPECT_EQ(back.enclosure.walls[5].name, "z_max");
  EXPECT_EQ(back.enclosure.walls[5].vertices, content_.enclosure.walls[5].vertices);
  EXPECT_EQ(back.origin, "a test");
}

TEST_F(DamagedHdf5, AFlippedByteIsNoticedOrStandsInUnusedSpace) {
  const std::string bytes = read_text_file(good_);
  for (int k = 0; k < 200; ++k) {
    std::string damaged = bytes;
    const auto at = random_bits(5, 1, k)[0] % bytes.size();
    damaged[at] = static_cast<char>(~damaged[at]);
    std::ofstream(bad_, std::ios::binary) << damaged;
    try {
      const ViewFactorFile back = read_view_factors(bad_);
      EXPECT_EQ(back.counts.hits, content_.counts.hits) << "byte " << at;
      EXPECT_EQ(back.counts.variance_factor, content_.counts.variance_factor) << "byte " << at;
      EXPECT_EQ(back.closed.value.size(), content_.closed.value.size()) << "byte " << at;
    } catch (const IoError&) {
    }
    if (HasFailure()) return;
  }
}

// Planted and caught (the read does not end): free space of the heap that says less than what is left.
TEST_F(DamagedHdf5, AHeapOfTextsThatIsDamagedIsReadToItsEnd) {
  const std::string bytes = read_text_file(good_);
  const std::size_t heap = bytes.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  for (std::size_t at = heap; at < std::min(heap + 300, bytes.size()); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(~damaged[at]);
    std::ofstream(bad_, std::ios::binary) << damaged;
    try {
      EXPECT_EQ(read_view_factors(bad_).counts.hits, content_.counts.hits) << "byte " << at;
    } catch (const Error&) {
    }
  }
}

/// Replaces a data set of a file.
template <class T>
void replace(const fs::path& file, const char* name, hid_t type, const std::vector<T>& values) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(opened, name, H5P_DEFAULT);
  const hsize_t rows = values.size();
  const hid_t space = H5Screate_simple(1, &rows, nullptr);
  const hid_t set = H5Dcreate2(opened, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (rows > 0) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set), H5Sclose(space), H5Fclose(opened);
}

TEST_F(DamagedHdf5, SetsThatDoNotFitAreRefused) {
  const auto refused = [&](const char* name, auto change) {
    fs::copy_file(good_, bad_, fs::copy_options::overwrite_existing);
    const Hdf5Reader in(good_);
    if (in.is_integer(name)) {
      auto values = in.read<std::int64_t>(name);
      change(values);
      replace(bad_, name, H5T_NATIVE_INT64, values);
    } else {
      auto values = in.read<double>(name);
      change(values);
      replace(bad_, name, H5T_NATIVE_DOUBLE, values);
    }
    EXPECT_THROW(read_view_factors(bad_), IoError) << name;
  };
  for (const char* name :
       {"/surfaces/area", "/surfaces/emissivity", "/view_factors/row_begin", "/view_factors/column",
        "/view_factors/value", "/view_factors/standard_error", "/rays/launched", "/rays/row_begin",
        "/rays/column", "/rays/hits", "/snapshot/radius", "/snapshot/particle", "/snapshot/wall_vertex_begin",
        "/snapshot/wall_triangle_begin", "/snapshot/wall_temperature", "/snapshot/wall_emissivity"}) {
    refused(name, [](auto& values) { values.resize(1); });
    refused(name, [](auto& values) { values.clear(); });
    refused(name, [](auto& values) { values.push_back(values.back()); });
    refused(name, [](auto& values) { values.front() = -7; });
  }
  for (const char* name : {"/view_factors/row_begin", "/view_factors/column", "/rays/row_begin",
                           "/rays/column", "/snapshot/wall_vertex_begin"})
    refused(name, [](auto& values) { values[values.size() / 2] = std::int64_t{1} << 30; });
  refused("/view_factors/value", [](auto& values) { values[0] *= -1; });
}

TEST_F(DamagedHdf5, AClaimBeyondTheFileIsRefusedBeforeItIsAllocated) {
  const hid_t opened = H5Fcreate(bad_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t rows = hsize_t{1} << 40, chunk = 65536;
  const hid_t space = H5Screate_simple(1, &rows, nullptr), layout = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(layout, 1, &chunk);
  const hid_t set = H5Dcreate2(opened, "/huge", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  H5Dclose(set), H5Sclose(space), H5Pclose(layout), H5Fclose(opened);
  EXPECT_THROW(Hdf5Reader(bad_).read<double>("/huge"), IoError);
}

/// A file as older versions wrote it: texts of variable length.
void write_old_texts(const fs::path& file, const std::vector<const char*>& texts) {
  const hid_t opened = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  const hsize_t rows = texts.size();
  const hid_t space = H5Screate_simple(1, &rows, nullptr), scalar = H5Screate(H5S_SCALAR);
  const hid_t set = H5Dcreate2(opened, "/names", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data());
  const hid_t attribute = H5Acreate2(opened, "method", type, scalar, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, texts.data());
  H5Aclose(attribute), H5Dclose(set), H5Sclose(space), H5Sclose(scalar), H5Tclose(type), H5Fclose(opened);
}

TEST_F(DamagedHdf5, TextsOfOlderFilesAreReadAndTheirHeapIsNotTrusted) {
  const std::vector<std::string> texts{"embree", "", "a longer text, with more than sixteen bytes", "\u00e4"};
  std::vector<const char*> pointers;
  for (const auto& text : texts) pointers.push_back(text.c_str());
  write_old_texts(good_, pointers);
  EXPECT_EQ(Hdf5Reader(good_).read_texts("/names"), texts);
  EXPECT_EQ(Hdf5Reader(good_).text_attribute("/", "method"), "embree");
  const std::string bytes = read_text_file(good_);
  const auto heap = bytes.find("GCOL");
  ASSERT_NE(heap, bytes.npos);
  for (std::size_t at = heap; at < heap + 160; ++at)
    for (const int flip : {1, 128, 255}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      std::ofstream(bad_, std::ios::binary) << damaged;
      try {
        EXPECT_EQ(Hdf5Reader(bad_).read_texts("/names").size(), texts.size());
      } catch (const Error&) {
      }
    }
}

}  // namespace
}  // namespace granrad
