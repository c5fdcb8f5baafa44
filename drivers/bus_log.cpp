#include "drivers/bus_log.h"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>

#include <cstdio>

#include "systems/foundation/visible_text.h"

namespace flinch {
namespace {

constexpr long told_each = 3;
constexpr std::size_t most_letters = 160;

bool is_power_of_ten(long number) {
  while (number % 10 == 0) number /= 10;
  return number == 1;
}

/// Names the vendor in the head of the packet, which is all that can be known of its sender; or a packet that
/// was empty.
bool is_about_a_packet(std::string_view line) {
  for (const char* const words : {"malformed packet", "(vendor ", ", vendor ", "recvmsg sock"}) {
    if (line.find(words) != std::string_view::npos) return true;
  }
  return false;
}

std::string shortened(std::string_view line) {
  return std::string(line.substr(0, most_letters)) + (line.size() > most_letters ? " ...\n" : "\n");
}

BusLog& log_of_program() {
  static BusLog log;
  return log;
}

}  // namespace

std::string BusLog::shown(std::string_view message) {
  const std::string_view line = message.substr(0, message.find('\n'));
  if (line.find("Certificate not valid") != std::string_view::npos) return shown_refusal(line);
  if (is_about_a_packet(line)) return shown_packet(line);
  return std::string(message) + (message.ends_with('\n') ? "" : "\n");
}

std::string BusLog::shown_packet(std::string_view line) {
  const long number = ++malformed_;
  if (number <= told_each) return shortened(line);
  return is_power_of_ten(number) ? "malformed packets on the bus so far: " + std::to_string(number) + "\n"
                                 : "";
}

std::string BusLog::shown_refusal(std::string_view line) {
  const long number = ++refused_certificates_;
  if (number == 1) return shortened(line);
  return is_power_of_ten(number) ? "certificates refused on the bus so far: " + std::to_string(number) + "\n"
                                 : "";
}

void tell_bus_log() {
  dds_set_log_sink(
      [](void* told, const dds_log_data_t* data) {
        const std::string text = visible_text(static_cast<BusLog*>(told)->shown({data->message, data->size}));
        std::fwrite(text.data(), 1, text.size(), stderr);
      },
      &log_of_program());
}

long refused_certificates() { return log_of_program().refused_certificates(); }

}  // namespace flinch
