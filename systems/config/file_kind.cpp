#include "systems/config/file_kind.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {
namespace {

using Keys = std::vector<std::string_view>;

struct KindOfFile {
  FileKind kind;
  Keys shown_by;   ///< one of these
  Keys excluded;   ///< and none of these, with which it is another kind
  const char* is;  ///< what a file is
  const char* use;
};

const std::vector<KindOfFile>& kinds() {
  static const std::vector<KindOfFile> all = {
      {FileKind::parameters,
       {"flinch_calibration"},
       {},
       "a parameter file",
       "scenarios and robot files name it in 'calibrations'"},
      {FileKind::mapping,
       {"log", "csv", "hdf5", "columns"},
       {},
       "the mapping of a log",
       "'flinch import' reads it"},
      {FileKind::scenario,
       {"robot"},
       {"flinch_calibration", "columns"},
       "a scenario",
       "'flinch run' runs it"},
      {FileKind::campaign,
       {"scenario", "scenarios", "grid", "draw"},
       {"log", "csv", "hdf5", "columns"},
       "a campaign",
       "'flinch campaign' runs it"},
      {FileKind::robot,
       {"kind", "legs"},
       {"flinch_calibration"},
       "a robot file",
       "scenarios name it as 'robot'"},
      {FileKind::data_spec,
       {"contacts", "recordings"},
       {"flinch_calibration"},
       "a data specification",
       "'flinch dataset' reads it"},
      {FileKind::figures, {"figures", "pictures"}, {}, "a file of figures", "'flinch reproduce' reads it"}};
  return all;
}

bool has_one(const Keys& keys, const Keys& of) {
  return std::any_of(keys.begin(), keys.end(),
                     [&](std::string_view key) { return std::find(of.begin(), of.end(), key) != of.end(); });
}

bool shows(const Keys& keys, const KindOfFile& kind) {
  return has_one(keys, kind.shown_by) && !has_one(keys, kind.excluded);
}

const KindOfFile* kind_shown(const Keys& keys) {
  const auto kind =
      std::find_if(kinds().begin(), kinds().end(), [&](const KindOfFile& one) { return shows(keys, one); });
  return kind == kinds().end() ? nullptr : &*kind;
}

void refuse(ConfigReader file, const KindOfFile& found, const std::string& wanted) {
  file.leave_rest_unread();
  file.problem("", std::string("is ") + found.is + ", not " + wanted + "; " + found.use);
  file.finish();
}

}  // namespace

std::optional<FileKind> kind_of(const std::filesystem::path& file) {
  const KindOfFile* const kind = kind_shown(ConfigReader::open(file).keys());
  return kind == nullptr ? std::nullopt : std::optional(kind->kind);
}

void require_kind(const ConfigReader& file, FileKind wanted) {
  const Keys keys = file.keys();
  const auto& expected = *std::find_if(kinds().begin(), kinds().end(),
                                       [wanted](const KindOfFile& one) { return one.kind == wanted; });
  const KindOfFile* const found = kind_shown(keys);
  if (shows(keys, expected) || found == nullptr) return;
  refuse(file, *found, expected.is);
}

void require_no_kind(const std::filesystem::path& file, const std::string& wanted) {
  if (file.extension() != ".yaml" && file.extension() != ".yml") return;
  const ConfigReader reader = ConfigReader::open(file);
  if (const KindOfFile* const found = kind_shown(reader.keys())) refuse(reader, *found, wanted);
}

}  // namespace flinch
