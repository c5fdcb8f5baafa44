#include "drivers/bus_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flinch {
namespace {

using ::testing::EndsWith;
using ::testing::StartsWith;

const std::string malformed = "recvUC: malformed packet received from vendor 1.16 state parse:DATA <" +
                              std::string(60'000, 'f') + ">\n";

TEST(TheLogOfTheBus, TellsEverythingButMalformedPackets) {
  BusLog log;
  const std::string message = "the keys are no good: " + std::string(5000, 'x') + "\n";
  for (int k = 0; k < 20; ++k) EXPECT_EQ(log.shown(message), message);
}

TEST(TheLogOfTheBus, EndsEachLine) {
  EXPECT_EQ(BusLog().shown("the end of the line is missing"), "the end of the line is missing\n");
}

TEST(TheLogOfTheBus, TellsMalformedPacketsShortly) {
  BusLog log;
  const std::string first = log.shown(malformed);
  EXPECT_THAT(first, StartsWith("recvUC: malformed packet received from vendor 1.16"));
  EXPECT_THAT(first, EndsWith(" ...\n"));
  EXPECT_LT(first.size(), 200U);
}

TEST(TheLogOfTheBus, CannotBeFilledByMalformedPackets) {
  BusLog log;
  std::string all;
  for (int k = 0; k < 20'000; ++k)
    all +=
        log.shown(malformed) + log.shown("plist(vendor 1.16): quickscan: parameter length 1 out of bounds") +
        log.shown("data(builtin, vendor 1.16): 1101032:d2a7a59f:851eca32:100c2 #1: deserialization failed") +
        log.shown("UDP recvmsg sock 8: ret 0 retcode 0") +
        log.shown("data(application, vendor 1.16): 1:2:3:4 #5: deserialization t/T failed");
  EXPECT_LT(all.size(), 1000U);
  EXPECT_THAT(all, EndsWith("malformed packets on the bus so far: 100000\n"));
}

TEST(TheLogOfTheBus, CannotBeFilledByCertificatesThatAreRefused) {
  BusLog log;
  const std::string refusal =
      "Begin handshake reply failed: Certificate not valid: error: unable to get local issuer certificate; "
      "subject: /CN=flinch robot(code: 200)\n";
  EXPECT_EQ(log.refused_certificates(), 0);
  EXPECT_THAT(log.shown(refusal), StartsWith("Begin handshake reply failed: Certificate not valid"));
  std::string all;
  for (int k = 1; k < 1000; ++k) all += log.shown(refusal);
  EXPECT_EQ(all,
            "certificates refused on the bus so far: 10\ncertificates refused on the bus so far: 100\n"
            "certificates refused on the bus so far: 1000\n");
  EXPECT_EQ(log.refused_certificates(), 1000);
}

}  // namespace
}  // namespace flinch
