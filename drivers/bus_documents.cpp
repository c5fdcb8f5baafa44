#include "drivers/bus_documents.h"

#include <array>

#include "drivers/topics.h"

namespace flinch {
namespace {

std::string document(const std::string& content) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<dds>\n" + content + "</dds>\n";
}

std::string domain_list(const DomainRange& domains) {
  return "<domains><id_range><min>" + std::to_string(domains.first) + "</min><max>" +
         std::to_string(domains.last) + "</max></id_range></domains>\n";
}

std::string date(std::time_t time) {
  std::tm utc{};
  gmtime_r(&time, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

std::string topic(const std::string& name) { return "<topic>" + name + "</topic>\n"; }

std::string topics_sent(BusRole role) {
  std::string list;
  for (const Topic* const sent : all_topics()) {
    if (sent->sender == role) list += topic(sent->name);
  }
  return list;
}

std::string topics_received(BusRole role) {
  if (role != BusRole::robot) return topic("*");
  return topic(torque_command_topic.name) + topic(drive_request_topic.name);
}

std::string rule(const char* action, const std::string& topics) {
  if (topics.empty()) return "";
  return std::string("<") + action + "><topics>\n" + topics + "</topics></" + action + ">\n";
}

}  // namespace

std::string governance_document(const DomainRange& domains) {
  // The plain SIGN would have one key for all receivers of a writer: each of them could speak in its name.
  const std::string sign = "SIGN_WITH_ORIGIN_AUTHENTICATION";
  return document("<domain_access_rules><domain_rule>\n" + domain_list(domains) +
                  "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
                  "<enable_join_access_control>true</enable_join_access_control>\n"
                  "<discovery_protection_kind>" +
                  sign +
                  "</discovery_protection_kind>\n"
                  "<liveliness_protection_kind>" +
                  sign +
                  "</liveliness_protection_kind>\n"
                  "<rtps_protection_kind>NONE</rtps_protection_kind>\n"
                  "<topic_access_rules><topic_rule>\n"
                  "<topic_expression>*</topic_expression>\n"
                  "<enable_discovery_protection>true</enable_discovery_protection>\n"
                  "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
                  "<enable_read_access_control>true</enable_read_access_control>\n"
                  "<enable_write_access_control>true</enable_write_access_control>\n"
                  "<metadata_protection_kind>" +
                  sign +
                  "</metadata_protection_kind>\n"
                  "<data_protection_kind>NONE</data_protection_kind>\n"
                  "</topic_rule></topic_access_rules>\n</domain_rule></domain_access_rules>\n");
}

std::string permissions_document(BusRole role, const std::string& subject, const KeyValidity& validity,
                                 const DomainRange& domains) {
  return document("<permissions><grant name=\"" + std::string(name(role)) + "\">\n<subject_name>" + subject +
                  "</subject_name>\n<validity><not_before>" + date(validity.from) +
                  "</not_before><not_after>" + date(validity.to) + "</not_after></validity>\n<allow_rule>\n" +
                  domain_list(domains) + rule("publish", topics_sent(role)) +
                  rule("subscribe", topics_received(role)) +
                  "</allow_rule>\n<default>DENY</default>\n</grant></permissions>\n");
}

}  // namespace flinch
