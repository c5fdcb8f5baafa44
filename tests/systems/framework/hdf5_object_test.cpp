#include "systems/framework/hdf5_object.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include "systems/framework/foreign_hdf5.h"
#include "systems/framework/recording_file.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/framework/honest_recording.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A log, and another file beside it with "/log/time" as well.
class Links : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* const name : {"other.h5", "log.h5"}) {
      const hid_t file = H5Fcreate((folder / name).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
      const hid_t group = H5Gcreate2(file, "log", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      const hsize_t size = 3;
      const double numbers[3] = {1.0, 2.0, 3.0};
      const hid_t space = H5Screate_simple(1, &size, nullptr);
      const hid_t set =
          H5Dcreate2(group, "time", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers);
      H5Dclose(set);
      H5Sclose(space);
      H5Gclose(group);
      H5Fclose(file);
    }
    log = H5Fopen((folder / "log.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const std::string other = (folder / "other.h5").string();
    H5Lcreate_external(other.c_str(), "/log/time", log, "outside", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(other.c_str(), "/log", log, "group_outside", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/group_outside/time", log, "soft_outside", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/soft_outside", log, "soft_soft_outside", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external("none.h5", "/log", log, "into_nothing", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/log/time", log, "soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(log, "/log/time", log, "hard", H5P_DEFAULT, H5P_DEFAULT);
  }
  void TearDown() override { H5Fclose(log); }

  std::vector<std::string> problems_of_set(const std::string& name) const {
    return test::problems_of([&] { internal::read_foreign_table(log, name); });
  }

  const test::TemporaryFolder folder;
  hid_t log = -1;
};

TEST_F(Links, AreFollowedWithinTheFile) {
  for (const char* const name : {"/log/time", "soft", "hard"})
    EXPECT_THAT(problems_of_set(name), ElementsAre());
  EXPECT_NO_THROW(internal::open_group(log, "/log"));
}

TEST_F(Links, AreNotFollowedIntoAnotherFileWhereverTheyStand) {
  for (const std::string name :
       {"outside", "group_outside/time", "/group_outside/time", "soft_outside", "soft_soft_outside"}) {
    EXPECT_THAT(problems_of_set(name),
                ElementsAre(AllOf(HasSubstr("'" + name + "' is a link into another file"),
                                  HasSubstr("other.h5', which is not followed"))));
  }
  EXPECT_THAT(problems_of_set("into_nothing/time"), ElementsAre(HasSubstr("into another file, 'none.h5'")));
  EXPECT_THAT(test::problems_of([&] { internal::open_group(log, "group_outside"); }),
              ElementsAre(HasSubstr("the group 'group_outside' is a link into another file")));
}

TEST_F(Links, OfAKindThatAProgramHasMadeAreRefused) {
  const auto lead = [](const char*, hid_t group, const void*, std::size_t, hid_t, hid_t) -> hid_t {
    return H5Oopen(group, "/log/time", H5P_DEFAULT);
  };
  H5L_class_t own{};
  own.version = H5L_LINK_CLASS_T_VERS;
  own.id = static_cast<H5L_type_t>(100);
  own.comment = "own";
  own.trav_func = lead;
  ASSERT_GE(H5Lregister(&own), 0);
  ASSERT_GE(H5Lcreate_ud(log, "own", own.id, nullptr, 0, H5P_DEFAULT, H5P_DEFAULT), 0);
  H5Lunregister(own.id);
  EXPECT_THAT(problems_of_set("own"), ElementsAre(HasSubstr("opening the data set 'own'")));
}

TEST_F(Links, OfARecordingLeadIntoNoOther) {
  write_recording(test::honest_recording(), folder / "honest.h5");
  write_recording(test::honest_recording(), folder / "linked.h5");
  const Recording honest = open_recording(folder / "honest.h5");
  const hid_t linked = H5Fopen((folder / "linked.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const std::string path = honest.signals.front().path;
  ASSERT_GE(H5Ldelete(linked, path.c_str(), H5P_DEFAULT), 0);
  ASSERT_GE(H5Lcreate_external((folder / "honest.h5").c_str(), path.c_str(), linked, path.c_str(),
                               H5P_DEFAULT, H5P_DEFAULT),
            0);
  H5Fclose(linked);
  EXPECT_THAT(test::problems_of([&] { open_recording(folder / "linked.h5"); }),
              ElementsAre(HasSubstr("the group '" + path + "' is a link into another file")));
}

}  // namespace
}  // namespace flinch
