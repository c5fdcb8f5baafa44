#include "systems/framework/foreign_hdf5.h"

#include <hdf5.h>

#include <algorithm>
#include <fstream>

#include "systems/foundation/bytes_of_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_chunks.h"

namespace flinch::internal {
namespace {

constexpr int deepest_group = 32;
constexpr std::size_t most_sets = 10'000;

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return (kind == H5T_FLOAT || kind == H5T_INTEGER) && H5Tget_size(type) <= sizeof(Number);
}

std::string taken(char* text) {
  const std::string copy = text == nullptr ? "" : text;
  H5free_memory(text);
  return copy;
}

std::vector<std::string> number_members(hid_t type) {
  std::vector<std::string> names;
  for (int i = 0; i < H5Tget_nmembers(type); ++i) {
    const Hdf5Object member(H5Tget_member_type(type, static_cast<unsigned>(i)), H5Tclose, "reading a member");
    if (is_number(member)) names.push_back(taken(H5Tget_member_name(type, static_cast<unsigned>(i))));
  }
  return names;
}

/// The text of an attribute; "" where it is none.
std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  try {
    return read_text(object, name);
  } catch (const SetupError&) {
    return "";
  }
}

/// Rows and columns of a data set of one or two dimensions. MATLAB writes a column as one row: where there
/// are more columns than rows, they are the rows.
struct Extent {
  hsize_t size[2] = {0, 1};
  bool is_turned = false;

  hsize_t rows() const { return size[is_turned ? 1 : 0]; }
  hsize_t columns() const { return size[is_turned ? 0 : 1]; }
};

Extent extent_of(const Hdf5Object& set, const std::string& name) {
  const Hdf5Object space(H5Dget_space(set), H5Sclose, "reading the size of '" + name + "'");
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != 1 && rank != 2)
    refuse(name, "has " + std::to_string(rank) + " dimensions; it must have 1 or 2");
  Extent extent;
  check(H5Sget_simple_extent_dims(space, extent.size, nullptr), "reading the size of '" + name + "'");
  extent.is_turned = rank == 2 && extent.size[1] > extent.size[0];
  return extent;
}

/// A data set that may be read as a whole.
struct Opened {
  Hdf5Object set;
  Extent extent;
  std::size_t numbers() const { return extent.size[0] * extent.size[1]; }
};

Opened open_checked(hid_t parent, const std::string& name, const std::string& member) {
  Opened opened{open_data_set(parent, name), {}};
  const Hdf5Object type(H5Dget_type(opened.set), H5Tclose, "reading the type of '" + name + "'");
  if (member.empty() && !is_number(type)) refuse(name, "has no numbers of at most 64 bits");
  if (!member.empty()) {
    const std::vector<std::string> members =
        H5Tget_class(type) == H5T_COMPOUND ? number_members(type) : std::vector<std::string>();
    if (std::find(members.begin(), members.end(), member) == members.end())
      refuse(name, "has no number '" + member + "'");
  }
  opened.extent = extent_of(opened.set, name);
  const auto& size = opened.extent.size;
  check_layout(opened.set, name);
  const std::size_t words = std::max<std::size_t>(H5Tget_size(type) / 8, 1);
  if (words > 1'000'000) refuse(name, "has rows of more than a megabyte");
  check_storage(opened.set, name, size[0], size[1] * words);
  CheckedChunks().require(opened.set, 0, size[0], size[1]);
  return opened;
}

/// The type in memory of a number, or of a compound with this member alone.
Hdf5Object memory_type(hid_t number, const std::string& member) {
  if (member.empty()) return {H5Tcopy(number), H5Tclose, "making a type"};
  Hdf5Object type(H5Tcreate(H5T_COMPOUND, H5Tget_size(number)), H5Tclose, "making a type");
  check(H5Tinsert(type, member.c_str(), 0, number), "making a type");
  return type;
}

template <class T>
std::vector<T> read_all(const Opened& opened, const std::string& name, const std::string& member,
                        hid_t wanted) {
  const Hdf5Object type = memory_type(wanted, member);
  std::vector<T> numbers(opened.numbers());
  check(H5Dread(opened.set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        "reading the data set '" + name + "'");
  return numbers;
}

/// Goes through the groups of a file.
class Visitor {
 public:
  explicit Visitor(hid_t file) : file_(file) {}

  ForeignContents visit() {
    visit_group("/", 0);
    return std::move(contents_);
  }

 private:
  void visit_group(const std::string& path, int depth) {
    const Hdf5Object group = open_group(file_, path);
    const std::uint64_t here = address(group);
    const bool is_within_itself = std::find(around_.begin(), around_.end(), here) != around_.end();
    if (depth > deepest_group || is_within_itself || ++groups_ > most_sets) return;
    around_.push_back(here);
    std::vector<std::string> names;
    const auto note = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
      auto& list = *static_cast<std::vector<std::string>*>(to);
      list.emplace_back(name);
      return list.size() < most_sets ? 0 : 1;
    };
    hsize_t from = 0;
    check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &from, note, &names), "reading a group");
    for (const std::string& name : names) {
      if (name == "#refs#" || name == "#subsystem#") continue;  // of MATLAB, for itself
      visit_object((path == "/" ? "" : path) + "/" + name, depth);
    }
    around_.pop_back();
  }

  void visit_object(const std::string& path, int depth) {
    H5L_info_t link{};
    if (H5Lget_info(file_, path.c_str(), &link, H5P_DEFAULT) < 0) return;
    if (link.type == H5L_TYPE_EXTERNAL) {
      contents_.left_out.push_back("'" + path + "' is a link into another file, which is not followed");
      return;
    }
    H5O_info_t object{};
    if (H5Oget_info_by_name(file_, path.c_str(), &object, H5P_DEFAULT) < 0) return;
    const bool is_alias = link.type == H5L_TYPE_SOFT;
    aliases_ += is_alias ? 1 : 0;
    try {
      if (object.type == H5O_TYPE_GROUP) {
        visit_group(path, depth + 1);
      } else if (object.type == H5O_TYPE_DATASET && contents_.tables.size() < most_sets) {
        describe(path);
      }
    } catch (const SetupError& error) {
      contents_.left_out.push_back(error.problems().front());
    }
    aliases_ -= is_alias ? 1 : 0;
  }

  void describe(const std::string& path) {
    const Hdf5Object set = open_data_set(file_, path);
    const Hdf5Object type(H5Dget_type(set), H5Tclose, "reading a type");
    ForeignShape shape{.name = path};
    if (H5Tget_class(type) == H5T_COMPOUND) {
      shape.members = number_members(type);
      if (shape.members.empty()) refuse(path, "is a compound without numbers");
    } else if (!is_number(type)) {
      refuse(path, "has no numbers of at most 64 bits");
    }
    check_layout(set, path);
    const Extent extent = extent_of(set, path);
    shape.rows = extent.rows();
    shape.columns = extent.columns();
    shape.is_alias = aliases_ > 0;
    shape.is_integer = H5Tget_class(type) == H5T_INTEGER;
    shape.unit = text_attribute(set, "unit");
    if (shape.unit.empty()) shape.unit = text_attribute(set, "units");
    contents_.tables.push_back(std::move(shape));
  }

  hid_t file_;
  std::vector<std::uint64_t> around_;  ///< the groups that are being visited
  std::size_t groups_ = 0;
  int aliases_ = 0;  ///< symbolic links on the way
  ForeignContents contents_;
};

/// The byte of the superblock that says who has the file open. [HDF5 file format specification 3.0, II.A]
constexpr std::size_t marks_at = 11;

bool is_marked(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(16, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto version = static_cast<unsigned char>(head[8]);
  return head.starts_with("\x89HDF\r\n\x1a\n") && version >= 2 &&
         (static_cast<unsigned char>(head[marks_at]) & 5U) != 0;
}

/// Opens the bytes in memory, where the library may clear the mark.
Hdf5Object open_image(std::string image) {
  const Hdf5Object access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "making file properties");
  check(H5Pset_fapl_core(access, 1U << 16U, false), "opening a file in memory");
  check(H5Pset_file_image(access, image.data(), image.size()), "opening a file in memory");
  const hbool_t clear = true;
  check(H5Pset(access, "clear_status_flags", &clear), "clearing the mark of a writer");
  return {H5Fopen("image", H5F_ACC_RDWR, access), H5Fclose,
          "opening the file: its writer was killed while it wrote, and not enough of it is there"};
}

}  // namespace

Hdf5Object open_foreign_file(const std::filesystem::path& file, bool& was_left_open) {
  was_left_open = is_marked(file);
  if (!was_left_open) return open_hdf5_file(file);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return open_image(bytes_of_file(file));
}

ForeignContents contents_of(Hdf5Object::Id file) { return Visitor(file).visit(); }

ForeignTable read_foreign_table(Hdf5Object::Id parent, const std::string& name, const std::string& member) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Opened opened = open_checked(parent, name, member);
  ForeignTable table{opened.extent.rows(), opened.extent.columns(),
                     read_all<double>(opened, name, member, H5T_NATIVE_DOUBLE)};
  if (!opened.extent.is_turned || table.columns == 1) return table;
  std::vector<double> turned(table.numbers.size());
  for (std::size_t row = 0; row < table.rows; ++row)
    for (std::size_t column = 0; column < table.columns; ++column)
      turned[row * table.columns + column] = table.numbers[column * table.rows + row];
  table.numbers = std::move(turned);
  return table;
}

std::vector<std::int64_t> read_foreign_integers(Hdf5Object::Id parent, const std::string& name,
                                                const std::string& member) {
  const Opened opened = open_checked(parent, name, member);
  if (opened.extent.columns() != 1) refuse(name, "has several columns");
  return read_all<std::int64_t>(opened, name, member, H5T_NATIVE_INT64);
}

}  // namespace flinch::internal
