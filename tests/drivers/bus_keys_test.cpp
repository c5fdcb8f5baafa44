#include "drivers/bus_keys.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdio>
#include <regex>
#include <set>

#include "drivers/topics.h"
#include "systems/foundation/setup_error.h"
#include "tests/drivers/key_folder.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::KeyFolder;
using test::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// What the program openssl answers, messages included.
std::string openssl(const std::string& arguments) {
  const std::string command = "openssl " + arguments + " 2>&1";
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string answer;
  for (int letter = std::fgetc(pipe); letter != EOF; letter = std::fgetc(pipe)) {
    answer += static_cast<char>(letter);
  }
  ::pclose(pipe);
  return answer;
}

std::string verification(const KeyFolder& keys, BusRole role, const char* signed_file) {
  return openssl("smime -verify -text -in " + keys.file(role, signed_file).string() + " -CAfile " +
                 keys.file(role, security_file::permissions_authority).string());
}

std::string certificate_check(const fs::path& certificate, const fs::path& authority) {
  return openssl("verify -CAfile " + authority.string() + " " + certificate.string());
}

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  ::stat(path.c_str(), &status);
  return status.st_mode & 0777;
}

std::multiset<std::string> topics_in(const std::string& permissions, const std::string& action) {
  const std::size_t from = permissions.find("<" + action + ">"), to = permissions.find("</" + action + ">");
  std::multiset<std::string> names;
  if (from == std::string::npos) return names;
  const std::string part = permissions.substr(from, to - from);
  const std::regex topic("<topic>([^<]*)</topic>");
  for (std::sregex_iterator at(part.begin(), part.end(), topic), end; at != end; ++at) {
    names.insert((*at)[1]);
  }
  return names;
}

std::string problem_of(const fs::path& folder, const BusKeySettings& settings) {
  try {
    make_bus_keys(folder, settings);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(BusKeys, GiveEachRoleACertificateOfTheIdentityAuthorityOnly) {
  const KeyFolder keys, others;
  for (const BusRole role : all_bus_roles) {
    const fs::path certificate = keys.file(role, security_file::certificate);
    EXPECT_THAT(certificate_check(certificate, keys.file(role, security_file::identity_authority)),
                HasSubstr(": OK"));
    EXPECT_THAT(certificate_check(certificate, keys.file(role, security_file::permissions_authority)),
                HasSubstr("verification failed"));
    EXPECT_THAT(certificate_check(certificate, others.file(role, security_file::identity_authority)),
                HasSubstr("verification failed"));
    EXPECT_EQ(openssl("x509 -noout -pubkey -in " + certificate.string()),
              openssl("pkey -pubout -in " + keys.file(role, security_file::private_key).string()));
  }
}

TEST(BusKeys, SignWhatIsAllowed) {
  const KeyFolder keys;
  for (const BusRole role : all_bus_roles) {
    EXPECT_THAT(
        verification(keys, role, security_file::governance),
        AllOf(HasSubstr("Verification successful"), HasSubstr("<allow_unauthenticated_participants>false<"),
              HasSubstr("<enable_join_access_control>true<"), Not(HasSubstr("_kind>SIGN<"))));
    const std::string permissions = verification(keys, role, security_file::permissions);
    EXPECT_THAT(permissions, HasSubstr("Verification successful"));
    const std::string subject = openssl("x509 -noout -subject -nameopt RFC2253 -in " +
                                        keys.file(role, security_file::certificate).string());
    EXPECT_THAT(permissions, HasSubstr(">" + subject.substr(8, subject.size() - 9) + "<")) << subject;
    const fs::path file = keys.file(role, security_file::permissions);
    test::overwrite(file, std::regex_replace(bytes_of(file), std::regex("DENY"), "ALLOW"));
    EXPECT_THAT(verification(keys, role, security_file::permissions), HasSubstr("Verification failure"));
  }
}

TEST(BusKeys, LetEachTopicBeSentByItsSenderOnly) {
  const KeyFolder keys;
  std::map<BusRole, std::multiset<std::string>> sent;
  for (const Topic* topic : all_topics()) sent[topic->sender].insert(topic->name);
  for (const BusRole role : all_bus_roles) {
    const std::string permissions = bytes_of(keys.file(role, security_file::permissions));
    EXPECT_EQ(topics_in(permissions, "publish"), sent[role]) << name(role);
    EXPECT_THAT(permissions, HasSubstr("<default>DENY</default>"));
  }
  EXPECT_THAT(sent[BusRole::observer], IsEmpty());
  const std::string robot = bytes_of(keys.file(BusRole::robot, security_file::permissions));
  EXPECT_THAT(topics_in(robot, "subscribe"), ElementsAre("flinch/drive_request", "flinch/torque_command"));
  const std::string controller = bytes_of(keys.file(BusRole::controller, security_file::permissions));
  EXPECT_THAT(topics_in(controller, "subscribe"), ElementsAre("*"));
}

TEST(BusKeys, ForgetNoTopic) {
  const std::string header = bytes_of(fs::path(FLINCH_SOURCE_DIR) / "drivers/topics.h");
  const std::regex declaration("extern const Topic ");
  const auto declared =
      std::distance(std::sregex_iterator(header.begin(), header.end(), declaration), std::sregex_iterator());
  std::set<std::string> names;
  for (const Topic* topic : all_topics()) names.insert(topic->name);
  EXPECT_EQ(static_cast<std::size_t>(declared), all_topics().size());
  EXPECT_EQ(names.size(), all_topics().size());
}

TEST(BusKeys, KeepPrivateKeysFromOthersAndThoseOfTheAuthoritiesFromAll) {
  const ::mode_t before = ::umask(0);
  const KeyFolder keys;
  ::umask(before);
  EXPECT_EQ(mode_of(keys.path()), 0700u);
  int private_keys = 0;
  for (const auto& entry : fs::recursive_directory_iterator(keys.path())) {
    if (entry.is_directory()) {
      EXPECT_EQ(mode_of(entry.path()), 0700u);
    } else if (bytes_of(entry.path()).find("PRIVATE KEY") != std::string::npos) {
      EXPECT_EQ(entry.path().filename(), security_file::private_key);
      EXPECT_EQ(mode_of(entry.path()), 0600u);
      ++private_keys;
    }
  }
  EXPECT_EQ(private_keys, 3);
}

TEST(BusKeys, AreGoodForTheDaysAndDomainsAskedFor) {
  const KeyFolder keys({.days = 2, .domains = {.first = 3, .last = 5}});
  const std::string certificate = keys.file(BusRole::robot, security_file::certificate).string();
  EXPECT_THAT(openssl("x509 -noout -checkend 172000 -in " + certificate), HasSubstr("will not expire"));
  EXPECT_THAT(openssl("x509 -noout -checkend 173000 -in " + certificate), HasSubstr("will expire"));
  for (const char* file : {security_file::governance, security_file::permissions}) {
    EXPECT_THAT(bytes_of(keys.file(BusRole::robot, file)), HasSubstr("<min>3</min><max>5</max>"));
  }
  EXPECT_THAT(problem_of(keys.path() / "new", {.days = 0}), HasSubstr("1 to 36500 days"));
  EXPECT_THAT(problem_of(keys.path() / "new", {.domains = {.first = 3, .last = 231}}), HasSubstr("0 to 230"));
}

TEST(BusKeys, ReplaceKeysOnlyWhenToldToAndNothingElseEver) {
  const KeyFolder keys;
  const fs::path key = keys.file(BusRole::robot, security_file::private_key);
  const std::string first = bytes_of(key);
  EXPECT_THAT(problem_of(keys.path(), {}), HasSubstr("--force"));
  EXPECT_EQ(bytes_of(key), first);
  EXPECT_EQ(problem_of(keys.path(), {.replace = true}), "");
  EXPECT_NE(bytes_of(key), first);

  const std::string second = bytes_of(key);
  test::overwrite(keys.path() / "robot" / "notes.txt", "mine");
  EXPECT_THAT(problem_of(keys.path(), {.replace = true}), HasSubstr("other things than keys"));
  EXPECT_EQ(bytes_of(key), second);
  EXPECT_THAT(problem_of(key, {.replace = true}), HasSubstr("this is none"));
  EXPECT_THAT(problem_of(keys.path() / "a" / "b", {}), HasSubstr("make it first"));
}

TEST(BusKeys, LeaveNothingBehindWhereTheyCannotBeWritten) {
  const TemporaryFolder place;
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{.rlim_cur = 1000, .rlim_max = limit.rlim_max};  // keys fit, signed documents do not
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string problem = problem_of(place.path() / "keys", {});
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  EXPECT_THAT(problem, HasSubstr("File too large"));
  EXPECT_TRUE(fs::is_empty(place.path()));
}

}  // namespace
}  // namespace flinch
