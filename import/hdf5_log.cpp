#include "import/hdf5_log.h"

#include <cmath>
#include <fstream>
#include <map>
#include <mutex>

#include "systems/foundation/problems_of_place.h"
#include "systems/framework/foreign_hdf5.h"

namespace flinch {
namespace {

constexpr std::size_t most_columns = 1000;  // of a data set

/// Does `work` with the file; what is wrong is told with its name.
template <class Work>
void with_file(const std::filesystem::path& file, const Work& work) {
  const std::lock_guard lock(internal::hdf5_mutex());
  out_of(file.string(), [&] {
    bool was_left_open = false;
    const internal::Hdf5Object opened = internal::open_foreign_file(file, was_left_open);
    work(opened, was_left_open);
  });
}

/// The group that a data set lies in.
std::string group_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

}  // namespace

bool is_hdf5(const std::filesystem::path& file) {
  // The signature stands at the begin, or behind a block of the user's: MATLAB puts 512 bytes there.
  std::ifstream stream(file, std::ios::binary);
  for (const std::streamoff at : {0, 512, 1024, 2048}) {
    std::string signature(8, '\0');
    stream.clear();
    stream.seekg(at);
    stream.read(signature.data(), 8);
    if (stream && signature == "\x89HDF\r\n\x1a\n") return true;
  }
  return false;
}

Hdf5Log::Hdf5Log(const std::filesystem::path& file) {
  file_ = file;
  with_file(file, [&](internal::Hdf5Object::Id opened, bool was_left_open) {
    if (was_left_open)
      remarks_.emplace_back(
          "its writer was killed and has left the file marked as open; what is there was read "
          "('h5clear -s' takes the mark off)");
    const internal::ForeignContents contents = internal::contents_of(opened);
    for (const std::string& left : contents.left_out) remarks_.push_back(left + "; left out");
    for (const internal::ForeignShape& shape : contents.tables) {
      const std::string table = group_of(shape.name) + ":" + std::to_string(shape.rows);
      const auto add = [&](const std::string& name, const Place& place) {
        columns_.push_back({.name = name,
                            .unit = shape.unit,
                            .table = table,
                            .rows = shape.rows,
                            .is_alias = shape.is_alias});
        places_.push_back(place);
      };
      for (const std::string& member : shape.members)
        add(shape.name + "." + member, {shape.name, member, 0, false});
      if (!shape.members.empty()) continue;
      if (shape.columns == 1) add(shape.name, {shape.name, "", 0, shape.is_integer});
      if (shape.columns > most_columns)
        remarks_.push_back("'" + shape.name + "' has " + std::to_string(shape.columns) +
                           " columns; left out");
      for (std::size_t i = 0; shape.columns > 1 && shape.columns <= most_columns && i < shape.columns; ++i)
        add(shape.name + "[" + std::to_string(i) + "]", {shape.name, "", i, false});
    }
  });
  throw_if_empty("data set of numbers that can be read");
}

// Names may lack the first stroke, and may number the one column of a data set; a member may stand as if it
// were in a group.
std::size_t Hdf5Log::find(const std::string& name) const {
  std::string whole = name.starts_with('/') ? name : "/" + name;
  const auto at = [&](const std::string& wanted) {
    std::size_t i = 0;
    while (i < columns_.size() && columns_[i].name != wanted) ++i;
    return i;
  };
  if (at(whole) < columns_.size()) return at(whole);
  if (whole.ends_with("[0]") && at(whole.substr(0, whole.size() - 3)) < columns_.size())
    return at(whole.substr(0, whole.size() - 3));
  const std::size_t last = whole.rfind('/');
  std::string member = whole;
  member[last] = '.';
  if (last > 0 && at(member) < columns_.size()) return at(member);
  for (const std::string& remark : remarks_) {
    if (remark.find("'" + whole.substr(0, whole.find('[')) + "'") != std::string::npos)
      throw SetupError(file_.string() + ": there is no column '" + name + "': " + remark);
  }
  return LogFile::find(name);
}

std::vector<std::vector<double>> Hdf5Log::read(std::span<const std::size_t> wanted, std::size_t most_rows) {
  std::vector<std::vector<double>> numbers;
  with_file(file_, [&](internal::Hdf5Object::Id opened, bool) {
    std::map<std::pair<std::string, std::string>, internal::ForeignTable> known;
    for (const std::size_t column : wanted) {
      const Place& place = places_[column];
      const auto key = std::pair(place.set, place.member);
      if (known.find(key) == known.end())
        known[key] = internal::read_foreign_table(opened, place.set, place.member);
      const internal::ForeignTable& table = known[key];
      std::vector<double>& values = numbers.emplace_back(std::min(table.rows, most_rows));
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = table.numbers[k * table.columns + place.column];
        if (!std::isfinite(values[k])) values[k] = std::nan("");
      }
    }
  });
  return numbers;
}

std::vector<std::int64_t> Hdf5Log::read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) {
  const Place& place = places_[column];
  std::vector<std::int64_t> instants;
  if (place.is_integer && unit == ClockUnit::ns) {
    with_file(file_, [&](internal::Hdf5Object::Id opened, bool) {
      instants = internal::read_foreign_integers(opened, place.set, place.member);
    });
    instants.resize(std::min(instants.size(), most_rows));
    return instants;
  }
  return instants_of_numbers(column, unit, most_rows);
}

}  // namespace flinch
