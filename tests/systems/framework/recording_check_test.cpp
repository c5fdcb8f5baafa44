// Recordings that lie: of sizes, types and places. Each is refused with a reason, or read; none does harm.
#include "systems/framework/recording_check.h"

#include <gmock/gmock.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <array>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <tuple>

#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_object.h"
#include "systems/framework/recording.h"
#include "tests/support/problems_of.h"
#include "tests/support/sanitized.h"
#include "tests/systems/framework/honest_recording.h"
#include "tests/systems/framework/refusal.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using test::TemporaryFile;
using testing::HasSubstr;

constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
constexpr std::size_t samples = test::honest_samples;

// --- what a hostile file is made of, by the calls of HDF5 ---

using Craft = std::function<void(hid_t file)>;

hid_t type_of(const std::string& name) {
  if (name == "text array") return H5Tcopy(H5T_C_S1);
  if (name == "endless text") {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    return type;
  }
  if (name == "compound") {
    const hid_t type = H5Tcreate(H5T_COMPOUND, 8);
    H5Tinsert(type, "part", 0, H5T_NATIVE_INT);
    return type;
  }
  if (name == "opaque") return H5Tcreate(H5T_OPAQUE, 8);
  if (name == "array") {
    const hsize_t size = 9;
    return H5Tarray_create2(H5T_NATIVE_INT64, 1, &size);
  }
  if (name == "list") return H5Tvlen_create(H5T_NATIVE_INT64);
  if (name == "float") return H5Tcopy(H5T_NATIVE_FLOAT);
  if (name == "double") return H5Tcopy(H5T_NATIVE_DOUBLE);
  if (name == "long double") return H5Tcopy(H5T_NATIVE_LDOUBLE);
  if (name == "byte") return H5Tcopy(H5T_NATIVE_SCHAR);
  return H5Tcopy(H5T_NATIVE_INT64);
}

void replace_attribute(hid_t file, const std::string& object, const std::string& name,
                       const std::string& type_name, hsize_t size, std::int64_t value) {
  const hid_t owner = H5Oopen(file, object.c_str(), H5P_DEFAULT);
  H5Adelete(owner, name.c_str());
  const hid_t type = type_of(type_name);
  const hid_t space = type_name == "nothing" ? H5Screate(H5S_NULL)
                      : size == 0            ? H5Screate(H5S_SCALAR)
                                             : H5Screate_simple(1, &size, nullptr);
  if (type_name != "missing") {
    const hid_t attribute = H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
    const std::vector<std::int64_t> values(std::max<std::size_t>(size, 1) * 16, value);
    if (type_name != "endless text" && type_name != "list") H5Awrite(attribute, type, values.data());
    H5Aclose(attribute);
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Oclose(owner);
}

struct Case {
  std::string name;
  Craft craft;
  bool harmless = false;  ///< may be read
};

std::vector<Case> attribute_cases() {
  const std::vector<std::pair<std::string, std::string>> attributes = {{"/", "flinch.signals"},
                                                                       {"/", "flinch.period_ns"},
                                                                       {"/", "seed"},
                                                                       {"bench/state", "fields"},
                                                                       {"bench/state/position", "unit"},
                                                                       {"bench/state/position", "frame"},
                                                                       {"bench/state/joints", "kind"},
                                                                       {"bench/state/joints", "capacity"},
                                                                       {"bench/state/joints", "resizable"}};
  struct Lie {
    const char* type;
    hsize_t size;
    std::int64_t value;
  };
  const std::vector<Lie> lies = {
      {"missing", 0, 0},         {"nothing", 0, 0},       {"integer", 10'000, 7}, {"integer", 2, 7},
      {"integer", 0, -1},        {"integer", 0, least},   {"integer", 0, most},   {"integer", 0, 1LL << 32},
      {"integer", 0, 2'000'000}, {"text array", 64, 'a'}, {"endless text", 0, 0}, {"compound", 0, 1},
      {"opaque", 0, 1},          {"array", 0, 1},         {"list", 0, 1},         {"double", 0, 1},
      {"long double", 3, 1}};
  std::vector<Case> cases;
  for (const auto& each : attributes) {
    const std::string object = each.first, name = each.second;
    for (const Lie& lie : lies) {
      const bool harmless = (name == "seed" && std::string(lie.type) == "missing") ||
                            (name == "flinch.period_ns" && std::string(lie.type) == "integer" &&
                             lie.size == 0 && lie.value > 0);
      cases.push_back(
          {object + "@" + name + ": " + std::to_string(lie.size) + " " + lie.type + " " +
               std::to_string(lie.value),
           [=](hid_t file) { replace_attribute(file, object, name, lie.type, lie.size, lie.value); },
           harmless});
    }
  }
  return cases;
}

struct Shape {
  std::vector<hsize_t> size;
  std::string type = "";                   ///< "": as it was
  std::function<void(hid_t)> layout = {};  ///< of the creation properties
  bool written = true;
};

/// Puts another data set into the place of one, with its attributes.
void replace_set(hid_t file, const std::string& path, const Shape& shape) {
  const hid_t old = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
  const hid_t old_type = H5Dget_type(old);
  const hid_t type = shape.type.empty() ? old_type : type_of(shape.type);
  const hid_t space = shape.size.empty()
                          ? H5Screate(H5S_SCALAR)
                          : H5Screate_simple(static_cast<int>(shape.size.size()), shape.size.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  if (shape.layout) shape.layout(creation);
  const hid_t made = H5Dcreate2(file, "other", type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (made < 0) throw SetupError("HDF5 makes no such data set");
  if (shape.written) {
    const std::vector<std::int64_t> zeros(1 << 16);
    H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
  }
  for (const char* const name : {"unit", "frame", "kind", "capacity", "resizable"}) {
    if (H5Aexists(old, name) <= 0) continue;
    const hid_t from = H5Aopen(old, name, H5P_DEFAULT), kind = H5Aget_type(from), one = H5Aget_space(from);
    const hid_t to = H5Acreate2(made, name, kind, one, H5P_DEFAULT, H5P_DEFAULT);
    std::vector<char> bytes(H5Tget_size(kind));
    H5Aread(from, kind, bytes.data());
    H5Awrite(to, kind, bytes.data());
    for (const hid_t id : {from, to}) H5Aclose(id);
    H5Tclose(kind);
    H5Sclose(one);
  }
  for (const hid_t id : {old, made}) H5Dclose(id);
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  H5Lmove(file, "other", file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  H5Pclose(creation);
  H5Sclose(space);
}

std::function<void(hid_t)> chunked(std::vector<hsize_t> size, std::function<void(hid_t)> filter = {}) {
  return [size = std::move(size), filter = std::move(filter)](hid_t creation) {
    H5Pset_chunk(creation, static_cast<int>(size.size()), size.data());
    if (filter) filter(creation);
  };
}

std::vector<Case> set_cases() {
  const std::vector<std::pair<std::string, hsize_t>> sets = {
      {"time_ns", 1},           {"bench/state/position", 3}, {"bench/state/count", 1},
      {"bench/state/valid", 1}, {"bench/state/joints", 6},   {"bench/state/joints.size", 2}};
  std::vector<Case> cases;
  for (const auto& each : sets) {
    const std::string path = each.first;
    const hsize_t columns = each.second;
    const auto add = [&cases, path](const std::string& what, const Shape& shape) {
      cases.push_back({path + ": " + what, [=](hid_t file) { replace_set(file, path, shape); }});
    };
    for (const char* const type :
         {"text array", "endless text", "compound", "opaque", "array", "list", "long double"}) {
      add(type, {.size = {samples, columns}, .type = type, .layout = {}, .written = false});
    }
    const bool is_real = path.ends_with("position") || path.ends_with("joints");
    add("another kind", {.size = {samples, columns}, .type = is_real ? "integer" : "float", .layout = {}});
    for (const auto& size : std::vector<std::vector<hsize_t>>{{},
                                                              {samples},
                                                              {samples, columns, 1},
                                                              {samples, columns + 1},
                                                              {samples, 0},
                                                              {samples - 1, columns},
                                                              {samples + 1, columns},
                                                              {0, columns}}) {
      add("shape of " + std::to_string(size.size()) + " with " +
              std::to_string(size.empty() ? 0 : size.back()),
          {.size = size, .type = "", .layout = {}});
    }
    for (const hsize_t rows : {hsize_t{1} << 24, hsize_t{1} << 40, (hsize_t{1} << 63) - 1}) {
      add(std::to_string(rows) + " rows",
          {.size = {rows, columns}, .type = "", .layout = chunked({4096, columns}), .written = false});
    }
    add("chunks of gigabytes", {.size = {hsize_t{1} << 31, columns},
                                .type = "",
                                .layout = chunked({hsize_t{1} << 28, columns}),
                                .written = false});
    add("packed in bits", {.size = {samples, columns},
                           .type = "",
                           .layout = chunked({samples, columns}, [](hid_t list) { H5Pset_nbit(list); })});
    add("packed by scale",
        {.size = {samples, columns}, .type = "", .layout = chunked({samples, columns}, [](hid_t list) {
                                                   H5Pset_scaleoffset(list, H5Z_SO_INT, 0);
                                                 })});
    add("in another file",
        {.size = {samples, columns},
         .type = "",
         .layout = [](hid_t list) { H5Pset_external(list, "/etc/passwd", 0, H5F_UNLIMITED); },
         .written = false});
    cases.push_back({path + ": a link to nowhere", [=](hid_t file) {
                       H5Ldelete(file, path.c_str(), H5P_DEFAULT);
                       H5Lcreate_soft("nowhere", file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
                     }});
    cases.push_back({path + ": a link to itself", [=](hid_t file) {
                       H5Ldelete(file, path.c_str(), H5P_DEFAULT);
                       H5Lcreate_soft(("/" + path).c_str(), file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
                     }});
    cases.push_back({path + ": a link to another file", [=](hid_t file) {
                       H5Ldelete(file, path.c_str(), H5P_DEFAULT);
                       H5Lcreate_external("/etc/passwd", "x", file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT);
                     }});
    cases.push_back({path + ": a group", [=](hid_t file) {
                       H5Ldelete(file, path.c_str(), H5P_DEFAULT);
                       H5Gclose(H5Gcreate2(file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
                     }});
  }
  return cases;
}

/// What the file says of the size of a field in one of its samples.
std::vector<Case> size_cases() {
  std::vector<Case> cases;
  const std::vector<std::int64_t> numbers = {least, -7, -1,        0,         2,         3,
                                             6,     7,  1LL << 31, 1LL << 32, 1LL << 62, most};
  for (const std::int64_t rows : numbers) {
    for (const std::int64_t columns : numbers) {
      const bool harmless = rows >= 0 && columns >= 0 && rows <= 6 && columns <= 6 && rows * columns <= 6;
      cases.push_back({"a matrix of " + std::to_string(rows) + " x " + std::to_string(columns),
                       [=](hid_t file) {
                         const hid_t set = H5Dopen2(file, "bench/state/joints.size", H5P_DEFAULT);
                         std::vector<std::int64_t> sizes(2 * samples, 1);
                         sizes[20] = rows;
                         sizes[21] = columns;
                         H5Dwrite(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, sizes.data());
                         H5Dclose(set);
                       },
                       harmless});
    }
  }
  return cases;
}

std::vector<Case> time_cases() {
  constexpr std::int64_t period = 1'000'000;
  std::vector<Case> cases;
  for (const std::size_t sample : {std::size_t{0}, std::size_t{1}, std::size_t{20}, samples - 1}) {
    const auto honest = static_cast<std::int64_t>(sample) * period;
    for (const std::int64_t time :
         {least, std::int64_t{-1}, std::int64_t{0}, honest - period, honest + period, most}) {
      const bool is_later = sample == 0 || time > honest - period;
      const bool is_earlier = sample + 1 == samples || time < honest + period;
      cases.push_back({"sample " + std::to_string(sample) + " at " + std::to_string(time),
                       [=](hid_t file) {
                         const hid_t set = H5Dopen2(file, "time_ns", H5P_DEFAULT);
                         std::vector<std::int64_t> times(samples);
                         for (std::size_t k = 0; k < samples; ++k)
                           times[k] = static_cast<std::int64_t>(k) * period;
                         times[sample] = time;
                         H5Dwrite(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, times.data());
                         H5Dclose(set);
                       },
                       is_later && is_earlier && time != least && time != most});
    }
  }
  return cases;
}

void write_text_attribute(hid_t file, const std::string& object, const std::string& name,
                          const std::string& text) {
  const hid_t owner = H5Oopen(file, object.c_str(), H5P_DEFAULT);
  H5Adelete(owner, name.c_str());
  const hid_t type = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  const hid_t attribute = H5Acreate2(owner, name.c_str(), type, one, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, type, text.c_str());
  H5Aclose(attribute);
  H5Tclose(type);
  H5Sclose(one);
  H5Oclose(owner);
}

/// Names of signals and fields that are none.
std::vector<Case> name_cases() {
  const std::vector<std::string> signals = {"..",
                                            "/",
                                            "//",
                                            "bench",
                                            "bench/",
                                            "bench/state/",
                                            "/bench//state",
                                            "time_ns",
                                            "bench/state/position",
                                            "bench/state\nbench/state",
                                            "bench/state\n",
                                            "bench/../bench/state",
                                            "bench/st\xc3",
                                            "/etc/passwd",
                                            std::string(60'000, 'a'),
                                            "a" + std::string(30'000, '/')};
  const std::vector<std::string> fields = {"..",
                                           "/",
                                           ".",
                                           "position\nposition",
                                           "position.size",
                                           "joints.size",
                                           "position\nno",
                                           "../state/position",
                                           "../../time_ns",
                                           "time_ns",
                                           "position/x",
                                           "/bench/state/position",
                                           "position\n\ncount",
                                           std::string(60'000, 'a'),
                                           std::string(30'000, '\n') + "position"};
  std::vector<Case> cases;
  for (const auto& [object, name, texts] :
       {std::tuple("/", "flinch.signals", signals), std::tuple("bench/state", "fields", fields)}) {
    for (const std::string& text : texts) {
      const bool harmless = text == "bench/state/" || text == "/bench//state" || text == "bench/state\n" ||
                            text == "/bench/state/position";
      cases.push_back({std::string(name) + " is " + text.substr(0, 60),
                       [object = object, name = name, text](hid_t file) {
                         write_text_attribute(file, object, name, text);
                       },
                       harmless});
    }
  }
  return cases;
}

/// Makes each case of an honest file, and expects it to be refused with a reason, or to be harmless.
void expect_no_harm(const std::vector<Case>& cases) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const TemporaryFile file;
  int refused = 0;
  for (const Case& each : cases) {
    write_recording(test::honest_recording(), file.path());
    const hid_t open = H5Fopen(file.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(open, 0);
    bool made = true;
    try {
      each.craft(open);
    } catch (const SetupError&) {
      made = false;  // HDF5 itself refuses to write it
    }
    H5Fclose(open);
    if (!made) continue;
    const std::string why = refusal(file.path());
    EXPECT_TRUE(each.harmless || !why.empty()) << each.name << " was read";
    refused += why.empty() ? 0 : 1;
  }
  std::cout << cases.size() << " recordings, " << refused << " refused" << std::endl;
}

TEST(HostileRecording, MayHaveAttributesOfAnyTypeAndSize) { expect_no_harm(attribute_cases()); }
TEST(HostileRecording, MayHaveDataSetsOfAnyTypeShapeAndPlace) { expect_no_harm(set_cases()); }
TEST(HostileRecording, MayClaimMatricesOfAnySize) { expect_no_harm(size_cases()); }
TEST(HostileRecording, MayHaveTimesThatDoNotGrow) { expect_no_harm(time_cases()); }
TEST(HostileRecording, HasNoTimesThatCannotBeSubtracted) {
  constexpr std::int64_t longest = internal::longest_time;
  EXPECT_NO_THROW(internal::check_times({-longest, 0, longest}));
  EXPECT_THROW(internal::check_times({-longest - 1, 0}), SetupError);
  EXPECT_THROW(internal::check_times({0, longest + 1}), SetupError);
  EXPECT_THROW(internal::checked_period(longest + 1), SetupError);
  EXPECT_GT(longest - -longest + internal::checked_period(longest).count(), 0) << "as the length of a run is";
}

TEST(HostileRecording, MayNameWhatIsNone) { expect_no_harm(name_cases()); }

TEST(HostileRecording, IsTriedInEnoughWays) {
  EXPECT_GE(attribute_cases().size() + set_cases().size() + size_cases().size() + time_cases().size() +
                name_cases().size(),
            500U);
}

TEST(HostileRecording, IsReadWhereItIsHonest) {
  const TemporaryFile file;
  write_recording(test::honest_recording(), file.path());
  EXPECT_EQ(refusal(file.path()), "");
  EXPECT_EQ(open_recording(file.path()).column("bench/state", "count").back(), 49.0);
}

TEST(HostileRecording, MayNotNameOneDataSetManyTimes) {
  const TemporaryFile file;
  write_recording(test::honest_recording(), file.path());
  const hid_t open = H5Fopen(file.path().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Lcreate_hard(open, "bench/state", open, "bench/twin", H5P_DEFAULT, H5P_DEFAULT);
  write_text_attribute(open, "/", "flinch.signals", "bench/state\nbench/twin");
  H5Fclose(open);
  EXPECT_THAT(refusal(file.path()), HasSubstr("bench/twin"));
}

TEST(HostileRecording, TakesNoMoreMemoryThanItsSizeAllows) {
#ifdef FLINCH_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps memory for itself";
#endif
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  expect_no_harm(set_cases());
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200'000) << "kB";
}

TEST(RecordingOfAnotherTool, IsRefusedWithTheReason) {
  const TemporaryFile file;
  internal::write_hdf5_result(file.path(), 1000, [](internal::Hdf5Object::Id id) {
    internal::write_text(id, "format", "lab log 3");
  });
  EXPECT_THAT(
      test::problems_of([&] { open_recording(file.path()); }),
      testing::ElementsAre(testing::HasSubstr("it says that it is 'lab log 3': HDF5 failed opening")));
}

}  // namespace
}  // namespace flinch
