#include "systems/framework/hdf5_object.h"

#include <hdf5.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>

#include "systems/foundation/readable_file.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch::internal {
namespace {

static_assert(std::is_same_v<hid_t, Hdf5Object::Id> && std::is_same_v<herr_t, int>);

Hdf5Object text_type(std::size_t size) {
  Hdf5Object type(H5Tcopy(H5T_C_S1), H5Tclose, "making a text type");
  check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "sizing a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "encoding a text");
  return type;
}

/// An attribute of one value: what it would read into has room for one.
Hdf5Object open_attribute(hid_t object, const std::string& name) {
  Hdf5Object attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose,
                       "opening the attribute '" + name + "'");
  const Hdf5Object space(H5Aget_space(attribute), H5Sclose,
                         "reading the size of the attribute '" + name + "'");
  const hssize_t values = H5Sget_simple_extent_npoints(space);
  if (values != 1) {
    throw SetupError("the attribute '" + name + "' has " + std::to_string(values) + " values instead of one");
  }
  return attribute;
}

/// Properties of groups or files without time stamps; `kind` is H5P_GROUP_CREATE or H5P_FILE_CREATE.
Hdf5Object timeless(hid_t kind) {
  Hdf5Object list(H5Pcreate(kind), H5Pclose, "making properties");
  check(H5Pset_obj_track_times(list, false), "leaving out time stamps");
  return list;
}

/// Notes where a link leads that leaves the file, and refuses to follow it.
herr_t refuse_link(const char* /*group*/, const char* /*parent*/, const char* file, const char* /*object*/,
                   unsigned* /*flags*/, hid_t /*access*/, void* target) {
  *static_cast<std::string*>(target) = file;
  return -1;
}

/// Opens what is in the file itself: `open` is handed the properties `access`. A link into another file could
/// lead to any that this program may read.
Hdf5Object open_own(const Hdf5Object& access, int (*close)(hid_t), const std::string& what,
                    const std::function<hid_t(hid_t access)>& open) {
  std::string target;
  check(H5Pset_elink_cb(access, &refuse_link, &target), "refusing links into other files");
  const hid_t id = open(access);
  if (id < 0 && !target.empty()) {
    throw SetupError(what + " is a link into another file, '" + target +
                     "', which is not followed; copy what it leads to into this file");
  }
  return {id, close, "opening " + what};
}

}  // namespace

std::mutex& hdf5_mutex() {
  static std::mutex mutex;
  return mutex;
}

void check(int status, const std::string& doing) {
  if (status < 0) throw SetupError("HDF5 failed " + doing);
}

void refuse(const std::string& name, const std::string& why) {
  throw SetupError("the data set '" + name + "' " + why);
}

void silence_hdf5() {
  static const bool stays_away_from_the_end = H5dont_atexit() >= 0;
  static_cast<void>(stays_away_from_the_end);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Object without_chunk_cache() {
  Hdf5Object list(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, "making access properties");
  check(H5Pset_chunk_cache(list, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 0, 1.0), "leaving out the chunk cache");
  return list;
}

Hdf5Object::Hdf5Object(Id id, int (*close)(Id), const std::string& doing) : id_(id), close_(close) {
  if (id_ < 0) throw SetupError("HDF5 failed " + doing);
}

Hdf5Object::~Hdf5Object() { close_now(); }

bool Hdf5Object::close_now() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

Hdf5Object create_hdf5_file(const std::filesystem::path& file) {
  silence_hdf5();
  const Hdf5Object access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "making file properties");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST), "choosing the file version");
  return {H5Fcreate(file.c_str(), H5F_ACC_TRUNC, timeless(H5P_FILE_CREATE), access), H5Fclose,
          "creating the file"};
}

Hdf5Object open_hdf5_file(const std::filesystem::path& file) {
  const std::string problem = problem_with_reading(file);
  if (!problem.empty()) throw SetupError(problem);
  silence_hdf5();
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
          "opening the file: it is no HDF5 file, or its end is missing"};
}

std::size_t file_size(Hdf5Object::Id object) {
  const Hdf5Object file(H5Iget_file_id(object), H5Fclose, "finding the file");
  hsize_t size = 0;
  check(H5Fget_filesize(file, &size), "reading the size of the file");
  return size;
}

void close_hdf5_file(Hdf5Object file) {
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "writing the file");
  if (!file.close_now()) throw SetupError("HDF5 failed closing the file");
}

void abandon_hdf5_file(Hdf5Object::Id file) noexcept {
  void* handle = nullptr;
  const int nowhere = ::memfd_create("abandoned", MFD_CLOEXEC);  // which can be truncated, unlike /dev/null
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) >= 0 && handle != nullptr && nowhere >= 0) {
    ::dup2(nowhere, *static_cast<const int*>(handle));
  }
  if (nowhere >= 0) ::close(nowhere);
}

void write_hdf5_result(const std::filesystem::path& file, std::size_t most_bytes,
                       const std::function<void(Hdf5Object::Id file)>& fill) {
  constexpr std::size_t descriptions = 1 << 20;
  ResultFile result(file);
  try {
    const std::lock_guard lock(hdf5_mutex());
    Hdf5Object hdf = create_hdf5_file(result.unfinished_name());
    try {
      result.reserve(most_bytes + descriptions);
      fill(hdf);
    } catch (...) {
      abandon_hdf5_file(hdf);
      throw;
    }
    close_hdf5_file(std::move(hdf));
  } catch (const SetupError& error) {
    throw SetupError(file.string() + ": the file cannot be written: " + error.what());
  }
  result.finish();
}

Hdf5Object make_group(Hdf5Object::Id file, const std::string& path) {
  const Hdf5Object creation = timeless(H5P_GROUP_CREATE);
  const std::string doing = "making the group '" + path + "'";
  for (std::size_t end = path.find('/');; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    if (H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) {
      Hdf5Object group(H5Gcreate2(file, part.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, doing);
      if (end == std::string::npos) return group;
    } else if (end == std::string::npos) {
      return {H5Gopen2(file, part.c_str(), H5P_DEFAULT), H5Gclose, doing};
    }
  }
}

Hdf5Object open_group(Hdf5Object::Id file, const std::string& path) {
  const Hdf5Object access(H5Pcreate(H5P_GROUP_ACCESS), H5Pclose, "making access properties");
  return open_own(access, H5Gclose, "the group '" + path + "'",
                  [&](hid_t own) { return H5Gopen2(file, path.c_str(), own); });
}

void write_text(Hdf5Object::Id object, const std::string& name, const std::string& text) {
  const Hdf5Object type = text_type(text.size());
  const Hdf5Object space(H5Screate(H5S_SCALAR), H5Sclose, "making an attribute");
  const Hdf5Object attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose, "making the attribute '" + name + "'");
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  check(H5Awrite(attribute, type, padded.data()), "writing the attribute '" + name + "'");
}

void write_integer(Hdf5Object::Id object, const std::string& name, std::int64_t value) {
  const Hdf5Object space(H5Screate(H5S_SCALAR), H5Sclose, "making an attribute");
  const Hdf5Object attribute(H5Acreate2(object, name.c_str(), H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose, "making the attribute '" + name + "'");
  check(H5Awrite(attribute, H5T_NATIVE_INT64, &value), "writing the attribute '" + name + "'");
}

Hdf5Object make_column(Hdf5Object::Id parent, const std::string& name, std::size_t rows,
                       std::optional<std::size_t> text_width) {
  const hsize_t length = rows;
  const Hdf5Object space(H5Screate_simple(1, &length, nullptr), H5Sclose, "making a column");
  const Hdf5Object properties = timeless(H5P_DATASET_CREATE);
  const std::string doing = "making the column '" + name + "'";
  const auto make = [&](hid_t type) -> Hdf5Object {
    return {H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
            doing};
  };
  return text_width ? make(text_type(*text_width)) : make(H5T_IEEE_F64LE);
}

void write_cells(Hdf5Object::Id column, std::size_t first, std::size_t rows, const void* cells) {
  if (rows == 0) return;
  const hsize_t start = first, count = rows;
  const Hdf5Object in_file(H5Dget_space(column), H5Sclose, "reading the size of a column");
  const Hdf5Object in_memory(H5Screate_simple(1, &count, nullptr), H5Sclose, "making a data space");
  check(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, &start, nullptr, &count, nullptr),
        "choosing rows of a column");
  const Hdf5Object type(H5Dget_type(column), H5Tclose, "reading the type of a column");
  const hid_t in_memory_type = H5Tget_class(type) == H5T_FLOAT ? H5T_NATIVE_DOUBLE : hid_t{type};
  check(H5Dwrite(column, in_memory_type, in_memory, in_file, H5P_DEFAULT, cells), "writing a column");
}

std::string read_text(Hdf5Object::Id object, const std::string& name) {
  const Hdf5Object attribute = open_attribute(object, name);
  const Hdf5Object type(H5Aget_type(attribute), H5Tclose, "reading the type of '" + name + "'");
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw SetupError("the attribute '" + name + "' is no text of fixed length");
  }
  const std::size_t size = H5Tget_size(type);
  if (size > file_size(object)) {
    throw SetupError("the attribute '" + name + "' has " + std::to_string(size) +
                     " letters, more than the file");
  }
  std::string text(size, '\0');
  check(H5Aread(attribute, type, text.data()), "reading the attribute '" + name + "'");
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

std::int64_t read_integer(Hdf5Object::Id object, const std::string& name) {
  const Hdf5Object attribute = open_attribute(object, name);
  const Hdf5Object type(H5Aget_type(attribute), H5Tclose, "reading the type of '" + name + "'");
  if (H5Tget_class(type) != H5T_INTEGER || H5Tget_size(type) > sizeof(std::int64_t)) {
    throw SetupError("the attribute '" + name + "' is no integer");
  }
  std::int64_t value = 0;
  check(H5Aread(attribute, H5T_NATIVE_INT64, &value), "reading the attribute '" + name + "'");
  return value;
}

std::vector<std::string> attribute_names(Hdf5Object::Id object) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names), "listing attributes");
  return names;
}

Hdf5Object open_data_set(Hdf5Object::Id parent, const std::string& name) {
  return open_own(without_chunk_cache(), H5Dclose, "the data set '" + name + "'",
                  [&](hid_t own) { return H5Dopen2(parent, name.c_str(), own); });
}

std::uint64_t address(Hdf5Object::Id object) {
  H5O_info_t info{};
  check(H5Oget_info2(object, &info, H5O_INFO_BASIC), "finding a data set");
  return info.addr;
}

}  // namespace flinch::internal
