#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/files/hdf5_handle.h"
#include "dem/base/files/hdf5_heap.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;
using Handle = Hdf5Handle;

/// Deflate packs no better: a dataset that claims more than this many times what the file holds is damaged.
constexpr hsize_t most_growth = 1040;

}  // namespace

struct Hdf5Reader::Impl {
  fs::path name;
  Handle file;

  [[noreturn]] void damaged(const std::string& what) const {
    throw IoError(
        fmt::format("{}: {} cannot be read (the file is damaged or truncated)", name.string(), what));
  }
  [[noreturn]] void unexpected(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name.string(), what));
  }
  /// Whether every link of a path is there; IoError where that cannot be told.
  bool exists(const std::string& path) const {
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
      const htri_t found = path == "/" ? 1 : H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT);
      if (found < 0) damaged(path);
      if (found == 0) return false;
      if (end == path.npos) return true;
    }
  }
  /// Refuses a dataset that claims more than the file can hold, before anything is allocated.
  void refuse_false_claim(hid_t set, const std::string& path, hsize_t rows, hsize_t row_bytes) const {
    const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(set), fs::file_size(name));
    if (rows > 0 && (stored == 0 || rows / most_growth > stored / row_bytes)) damaged(path);
    const Handle layout(H5Dget_create_plist(set), H5Pclose);
    hsize_t chunk[2] = {1, 1};
    if (H5Pget_layout(layout) != H5D_CHUNKED || H5Pget_chunk(layout, 2, chunk) < 0) return;
    if (chunk[0] / most_growth > fs::file_size(name) / row_bytes) damaged(path);
  }
  Handle dataset(const std::string& path) const {
    if (!exists(path)) unexpected(fmt::format("there is no dataset {}", path));
    Handle set(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.valid()) damaged(path);
    return set;
  }
  /// Rows of a dataset that must be [rows] or [rows, columns].
  std::size_t rows_of(hid_t set, const std::string& path, std::size_t columns) const {
    const Handle space(H5Dget_space(set), H5Sclose);
    hsize_t shape[2] = {0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank != (columns > 1 ? 2 : 1) || H5Sget_simple_extent_dims(space, shape, nullptr) < 0 ||
        shape[1] != columns)
      unexpected(fmt::format("dataset {} must have the shape [rows{}]", path,
                             columns > 1 ? fmt::format(", {}", columns) : ""));
    const Handle type(H5Dget_type(set), H5Tclose);
    refuse_false_claim(set, path, shape[0], columns * std::max<std::size_t>(1, H5Tget_size(type)));
    return shape[0];
  }
  bool has_attribute(const std::string& object, const std::string& attribute_name) const {
    if (!exists(object)) return false;
    const htri_t found = H5Aexists_by_name(file, object.c_str(), attribute_name.c_str(), H5P_DEFAULT);
    if (found < 0) damaged(attribute_name);
    return found > 0;
  }
  Handle attribute(const std::string& object, const std::string& attribute_name) const {
    if (!has_attribute(object, attribute_name))
      unexpected(fmt::format("{} has no attribute {}", object, attribute_name));
    Handle found(H5Aopen_by_name(file, object.c_str(), attribute_name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
    if (!found.valid()) damaged(attribute_name);
    return found;
  }
  void scalar_attribute(const std::string& object, const std::string& attribute_name, hid_t type,
                        void* value) const {
    const Handle found = attribute(object, attribute_name);
    const Handle space(H5Aget_space(found), H5Sclose);
    if (H5Sget_simple_extent_npoints(space) != 1)
      unexpected(fmt::format("attribute {} of {} must be one number", attribute_name, object));
    if (H5Aread(found, type, value) < 0) damaged(attribute_name);
  }
};

Hdf5Reader::Hdf5Reader(fs::path name) {
  silence_hdf5();
  if (!fs::is_regular_file(name)) throw IoError(fmt::format("{}: there is no such file", name.string()));
  Handle file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid())
    throw IoError(fmt::format("{}: is not an HDF5 file, or is damaged or truncated", name.string()));
  impl_.reset(new Impl{std::move(name), std::move(file)});
}

Hdf5Reader::~Hdf5Reader() = default;

bool Hdf5Reader::has(const std::string& name) const {
  return impl_->exists(name);
}

bool Hdf5Reader::has_attribute(const std::string& object, const std::string& name) const {
  return impl_->has_attribute(object, name);
}

std::vector<std::string> Hdf5Reader::children(const std::string& group) const {
  std::vector<std::string> names;
  if (!has(group)) impl_->unexpected(fmt::format("there is no group {}", group));
  const Handle opened(H5Gopen2(impl_->file, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!opened.valid()) impl_->damaged(group);
  const auto remember = [](hid_t, const char* name, const H5L_info_t*, void* all) -> herr_t {
    static_cast<std::vector<std::string>*>(all)->emplace_back(name);
    return 0;
  };
  if (H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, remember, &names) < 0) impl_->damaged(group);
  return names;
}

bool Hdf5Reader::is_integer(const std::string& name) const {
  const Handle set = impl_->dataset(name), type(H5Dget_type(set), H5Tclose);
  return H5Tget_class(type) == H5T_INTEGER;
}

template <class T>
std::vector<T> Hdf5Reader::read(const std::string& name, std::size_t columns) const {
  const Handle set = impl_->dataset(name);
  std::vector<T> values(impl_->rows_of(set, name, columns) * columns);
  if (!values.empty() && H5Dread(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    impl_->damaged(name);
  return values;
}

template std::vector<double> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<std::int64_t> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<std::int32_t> Hdf5Reader::read(const std::string&, std::size_t) const;
template std::vector<std::uint8_t> Hdf5Reader::read(const std::string&, std::size_t) const;

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name) const {
  const Handle set = impl_->dataset(name), type(H5Dget_type(set), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING) impl_->unexpected(fmt::format("dataset {} must hold texts", name));
  const std::size_t rows = impl_->rows_of(set, name, 1);
  std::vector<std::string> texts;
  if (H5Tis_variable_str(type) > 0) {
    const Hdf5Heap heap(impl_->name);
    const haddr_t offset = rows > 0 ? H5Dget_offset(set) : 0;
    for (std::size_t k = 0; k < rows; ++k) {
      const auto reference = offset == HADDR_UNDEF ? std::nullopt : heap.reference(offset, k);
      const auto text = reference ? heap.text(*reference) : std::nullopt;
      if (!text) impl_->damaged(name);
      texts.push_back(*text);
    }
    return texts;
  }
  const std::size_t length = H5Tget_size(type);
  std::string bytes(rows * length, '\0');
  if (rows > 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) impl_->damaged(name);
  for (std::size_t k = 0; k < rows; ++k) {
    texts.push_back(bytes.substr(k * length, length));
    texts.back().resize(std::min(texts.back().find('\0'), length));
  }
  return texts;
}

std::string Hdf5Reader::text_attribute(const std::string& object, const std::string& name) const {
  const Handle found = impl_->attribute(object, name), type(H5Aget_type(found), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING)
    impl_->unexpected(fmt::format("attribute {} of {} must be a text", name, object));
  if (H5Tis_variable_str(type) > 0) {
    char* value = nullptr;
    if (!Hdf5Heap(impl_->name).is_sound() || H5Aread(found, type, &value) < 0) impl_->damaged(name);
    const std::string copy(value ? value : "");
    H5free_memory(value);
    return copy;
  }
  if (H5Tget_size(type) > fs::file_size(impl_->name)) impl_->damaged(name);
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(found, type, text.data()) < 0) impl_->damaged(name);
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& object, const std::string& name) const {
  std::int64_t value = 0;
  impl_->scalar_attribute(object, name, H5T_NATIVE_INT64, &value);
  return value;
}

double Hdf5Reader::real_attribute(const std::string& object, const std::string& name) const {
  double value = 0;
  impl_->scalar_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
  return value;
}

}  // namespace granrad
