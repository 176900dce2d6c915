#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/files/hdf5_handle.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;
using Handle = Hdf5Handle;

constexpr hsize_t chunk_rows = 1 << 16;

/// UTF-8 text of at most `length` bytes.
Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// Creation properties of an object that stores no time of its making: equal content is equal bytes.
Handle without_clock(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(list, false);
  return list;
}

/// The groups above `name` that are missing (HDF5 would make them itself, with a time in them).
void make_parents(hid_t file, const std::string& name) {
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    const std::string parent = name.substr(0, slash);
    if (H5Lexists(file, parent.c_str(), H5P_DEFAULT) > 0) continue;
    const Handle made(
        H5Gcreate2(file, parent.c_str(), H5P_DEFAULT, without_clock(H5P_GROUP_CREATE), H5P_DEFAULT),
        H5Gclose);
  }
}

/// fsync of a file or folder.
bool synced(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY);
  if (fd < 0) return false;
  const bool done = ::fsync(fd) == 0;
  ::close(fd);
  return done;
}

}  // namespace

struct Hdf5Writer::Impl {
  fs::path target, temporary;
  Handle file;

  [[noreturn]] void fail(const std::string& what) const {
    throw IoError(fmt::format("{}: cannot write {} (disk full, or no permission?)", target.string(), what));
  }
  void require(bool done, const std::string& what) const {
    if (!done) fail(what);
  }
  void attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                 const void* value) {
    const Handle owner(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose);
    const Handle made(H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(made.valid() && H5Awrite(made, type, value) >= 0, name);
  }
};

Hdf5Writer::Hdf5Writer(fs::path target) {
  silence_hdf5();
  fs::path temporary = target;
  temporary += ".tmp";
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);  // checksums of metadata, chunk indices too
  Handle file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, without_clock(H5P_FILE_CREATE), access), H5Fclose);
  if (!file.valid()) throw IoError(fmt::format("{}: cannot be created", temporary.string()));
  impl_.reset(new Impl{std::move(target), std::move(temporary), std::move(file)});
}

Hdf5Writer::~Hdf5Writer() {
  if (!impl_->file.valid()) return;
  impl_->file.close();
  std::error_code ignored;
  fs::remove(impl_->temporary, ignored);
}

template <class T>
void Hdf5Writer::write(const std::string& name, const T* values, std::size_t rows, std::size_t columns) {
  const hsize_t shape[2] = {rows, columns}, chunk[2] = {std::min<hsize_t>(rows, chunk_rows), columns};
  const int rank = columns > 1 ? 2 : 1;
  const Handle space(H5Screate_simple(rank, shape, nullptr), H5Sclose);
  const Handle layout = without_clock(H5P_DATASET_CREATE);
  make_parents(impl_->file, name);
  if (rows > 0) {
    H5Pset_chunk(layout, rank, chunk);
    if (std::is_integral_v<T>) {
      H5Pset_shuffle(layout);
      H5Pset_deflate(layout, 1);
    }
    H5Pset_fletcher32(layout);
  }
  const Handle set(
      H5Dcreate2(impl_->file, name.c_str(), native_type<T>(), space, H5P_DEFAULT, layout, H5P_DEFAULT),
      H5Dclose);
  impl_->require(set.valid(), name);
  if (rows > 0)
    impl_->require(H5Dwrite(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, name);
}

template void Hdf5Writer::write(const std::string&, const double*, std::size_t, std::size_t);
template void Hdf5Writer::write(const std::string&, const std::int64_t*, std::size_t, std::size_t);
template void Hdf5Writer::write(const std::string&, const std::int32_t*, std::size_t, std::size_t);
template void Hdf5Writer::write(const std::string&, const std::uint8_t*, std::size_t, std::size_t);

void Hdf5Writer::write(const std::string& name, const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const auto& text : texts) length = std::max(length, text.size());
  std::string bytes;
  for (const auto& text : texts) bytes.append(text).append(length - text.size(), '\0');
  const hsize_t rows = texts.size(), chunk = std::min<hsize_t>(rows, chunk_rows);
  const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose), type = text_type(length);
  make_parents(impl_->file, name);
  const Handle layout = without_clock(H5P_DATASET_CREATE);
  if (rows > 0) {
    H5Pset_chunk(layout, 1, &chunk);
    H5Pset_fletcher32(layout);
  }
  const Handle set(H5Dcreate2(impl_->file, name.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT),
                   H5Dclose);
  impl_->require(set.valid(), name);
  if (rows > 0) impl_->require(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0, name);
}

void Hdf5Writer::group(const std::string& name) {
  make_parents(impl_->file, name);
  const Handle made(
      H5Gcreate2(impl_->file, name.c_str(), H5P_DEFAULT, without_clock(H5P_GROUP_CREATE), H5P_DEFAULT),
      H5Gclose);
  impl_->require(made.valid(), name);
}

void Hdf5Writer::link(const std::string& existing, const std::string& name) {
  make_parents(impl_->file, name);
  impl_->require(
      H5Lcreate_hard(impl_->file, existing.c_str(), impl_->file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0,
      name);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size()), space(H5Screate(H5S_SCALAR), H5Sclose);
  impl_->attribute(object, name, type, space, text.c_str());
}

void Hdf5Writer::variable_text_attribute(const std::string& object, const std::string& name,
                                         const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const char* first = text.c_str();
  impl_->attribute(object, name, type, space, &first);
}

void Hdf5Writer::fixed_text_attribute(const std::string& object, const std::string& name,
                                      const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  impl_->attribute(object, name, type, space, text.c_str());
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name,
                           const std::vector<std::int64_t>& values) {
  const hsize_t count = values.size();
  const Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  impl_->attribute(object, name, H5T_NATIVE_INT64, space, values.data());
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  impl_->attribute(object, name, H5T_NATIVE_DOUBLE, space, &value);
}

void Hdf5Writer::commit() {
  const fs::path folder = fs::absolute(impl_->target).parent_path();
  std::error_code failed;
  const bool closed = impl_->file.close() && synced(impl_->temporary);
  if (closed) fs::rename(impl_->temporary, impl_->target, failed);
  if (!closed || failed) {
    std::error_code ignored;
    fs::remove(impl_->temporary, ignored);
    impl_->fail("the file");
  }
  synced(folder);
}

}  // namespace granrad
