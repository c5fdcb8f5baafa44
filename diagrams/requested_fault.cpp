#include "diagrams/requested_fault.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "systems/foundation/findings.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Kinds = unsigned;
constexpr Kinds bit(FaultKind kind) { return 1U << static_cast<unsigned>(kind); }
constexpr Kinds all_of(std::initializer_list<FaultKind> kinds) {
  Kinds set = 0;
  for (const FaultKind kind : kinds) set |= bit(kind);
  return set;
}

using enum FaultKind;
constexpr Kinds of_values =
    all_of({off, stuck, noise, wrong, drifting, scaled, delayed, intermittent, reversed, saturated});
constexpr Kinds of_both_parts = all_of({off, stuck, delayed, intermittent, reversed, scaled, turned});
constexpr Kinds of_samples = all_of({off, stuck, delayed, intermittent});

/// What users call a signal, and what can be asked of it.
struct SignalWords {
  FaultSignal signal;
  std::string_view one, all;
  Kinds kinds;
};
constexpr std::array signals{
    SignalWords{FaultSignal::encoder, "encoder", "encoders", of_values},
    SignalWords{FaultSignal::passive_encoder, "passive_encoder", "passive_encoders", of_values},
    SignalWords{FaultSignal::current, "current", "currents", of_values},
    SignalWords{FaultSignal::gyroscope, "gyroscope", "gyroscope", of_values},
    SignalWords{FaultSignal::accelerometer, "accelerometer", "accelerometer", of_values},
    SignalWords{FaultSignal::imu, "imu", "imu", of_both_parts},
    SignalWords{FaultSignal::force_torque, "force_torque", "force_torque", of_values},
    SignalWords{FaultSignal::status, "status", "status", of_samples},
    SignalWords{FaultSignal::drive, "drive", "drives", of_values},
    SignalWords{FaultSignal::brake, "brake", "brakes", all_of({off, stuck, scaled, delayed})},
    SignalWords{FaultSignal::link, "link", "link", all_of({off, delayed, intermittent})},
};

enum class Size { none, may, must };
struct KindWords {
  FaultKind kind;
  std::string_view name;
  Size size;
};
constexpr std::array kinds{
    KindWords{off, "off", Size::none},           KindWords{stuck, "stuck", Size::may},
    KindWords{noise, "noise", Size::must},       KindWords{wrong, "wrong", Size::must},
    KindWords{drifting, "drifting", Size::must}, KindWords{scaled, "scaled", Size::must},
    KindWords{delayed, "delayed", Size::must},   KindWords{intermittent, "intermittent", Size::may},
    KindWords{reversed, "reversed", Size::none}, KindWords{saturated, "saturated", Size::must},
    KindWords{turned, "turned", Size::must},
};

const SignalWords& words_of(FaultSignal signal) { return signals[static_cast<std::size_t>(signal)]; }
const KindWords& words_of(FaultKind kind) { return kinds[static_cast<std::size_t>(kind)]; }

/// How many of it a robot has; 0 where it has none, or only one that cannot be told apart.
int count_of(const RequestedFault& fault, const ParallelRobot& robot) {
  switch (fault.signal) {
    case FaultSignal::encoder:
    case FaultSignal::current:
    case FaultSignal::drive:
    case FaultSignal::brake:
      return robot.drives();
    case FaultSignal::passive_encoder:
      return robot.passive_joints();
    case FaultSignal::gyroscope:
    case FaultSignal::accelerometer:
    case FaultSignal::force_torque:
      return 3;
    case FaultSignal::imu:
      return fault.kind == turned ? 3 : 0;
    case FaultSignal::status:
    case FaultSignal::link:
      break;
  }
  return 0;
}

std::string name_of(const RequestedFault& fault) {
  const SignalWords& words = words_of(fault.signal);
  return fault.index ? std::string(words.one) + std::to_string(*fault.index + 1) : std::string(words.all);
}

void check_place(const RequestedFault& fault, const ParallelRobot& robot, Findings& found) {
  const int count = count_of(fault, robot);
  if (fault.signal == FaultSignal::passive_encoder && count == 0) {
    found.add("the robot has no passive encoders");
  } else if (fault.index && (*fault.index < 0 || *fault.index >= count)) {
    const std::string most = std::to_string(count);
    found.add(count == 0 ? "has no number; there is one only" : "the numbers are 1 to " + most);
  }
}

void check_size(const RequestedFault& fault, Findings& found) {
  const KindWords& words = words_of(fault.kind);
  if (words.size == Size::must && !fault.size) found.add("'" + std::string(words.name) + "' needs a size");
  if (words.size == Size::none && fault.size) found.add("'" + std::string(words.name) + "' has no size");
  if (!fault.size || words.size == Size::none) return;
  const double size = *fault.size;
  const bool has_noise = fault.kind == noise || (fault.kind == stuck && fault.signal != FaultSignal::drive);
  const bool holds = fault.signal == FaultSignal::brake;
  if (!std::isfinite(size)) found.add("the size must be a finite number");
  if (has_noise && size < 0.0) found.add("the size of noise must not be negative");
  if (fault.kind == saturated && size < 0.0) found.add("the size, a limit, must not be negative");
  if (fault.kind == intermittent && !(size > 0.0 && size <= 1.0))
    found.add("the size, a share of all ticks, must be above 0 and at most 1");
  if (fault.kind == delayed && !(size >= 0.0 && size <= (holds ? 10.0 : to_seconds(longest_delay))))
    found.add(holds ? "the size, a delay, must be between 0 and 10 s"
                    : "the size, a delay, must be between 0 and 0.06 s");
  if (holds && fault.kind == scaled && !(size >= 0.0 && size <= 1.0))
    found.add("the size, a share of what the brake holds, must be between 0 and 1");
}

[[noreturn]] void refuse(const std::string& text, const std::vector<std::string>& why) {
  std::vector<std::string> sentences;
  for (const std::string& each : why) sentences.push_back("fault '" + text + "': " + each);
  throw SetupError(sentences);
}

double number_in(const std::string& text, const std::string& of, const char* what) {
  double value = 0.0;
  const char* const end = of.data() + of.size();
  const auto [rest, error] = std::from_chars(of.data(), end, value);
  if (error == std::errc{} && rest == end && std::isfinite(value)) return value;
  refuse(text, {std::string("the ") + what + " '" + of + "' is no number"});
}

template <class Words>
std::vector<std::string> list_of(const Words& words, std::string_view Words::value_type::*name) {
  std::vector<std::string> names;
  for (const auto& each : words) names.emplace_back(each.*name);
  return names;
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? std::string(text.data(), end) : std::string();
}

// By a quotient, which is the nearest number to what users wrote; a product with 1e-9 is not.
std::string seconds_text(Time time) { return short_number(static_cast<double>(time.count()) / 1e9); }

}  // namespace

std::vector<std::string> problems(const RequestedFault& fault, const ParallelRobot& robot) {
  Findings found(name_of(fault) + ": ");
  check_place(fault, robot, found);
  const Kinds possible = words_of(fault.signal).kinds;
  if ((possible & bit(fault.kind)) == 0) {
    std::string can;
    for (const KindWords& each : kinds) {
      if ((possible & bit(each.kind)) != 0) can += (can.empty() ? "" : ", ") + std::string(each.name);
    }
    found.add("it cannot be '" + std::string(words_of(fault.kind).name) + "'; it can be: " + can);
  }
  if (fault.begin < Time::zero()) found.add("the time must not be negative");
  check_size(fault, found);
  return found.take();
}

std::vector<std::string> problems(const RequestedFault& fault, const FaultPlace& place) {
  Findings found(name_of(fault) + ": ");
  const bool acts = fault.signal == FaultSignal::drive || fault.signal == FaultSignal::brake;
  if (acts && !place.moves)
    found.add("a recording does not move; faults of drives and brakes need a simulated robot");
  if (fault.signal == FaultSignal::passive_encoder && !place.has_passive_encoders)
    found.add("there are no passive encoders");
  if (fault.signal == FaultSignal::force_torque && !place.has_force_torque)
    found.add("there is no such sensor; without an obstacle there is none below it");
  if (fault.begin >= place.end)
    found.add("it would begin at " + seconds_text(fault.begin) + " s, but the run ends at " +
              seconds_text(place.end) + " s");
  return found.take();
}

void require_possible(const std::vector<RequestedFault>& faults, const FaultPlace& place) {
  std::vector<std::string> impossible;
  for (const RequestedFault& fault : faults) {
    for (std::string& each : problems(fault, place)) impossible.push_back("fault " + std::move(each));
  }
  throw_if_any(std::move(impossible));
}

void set_signal(RequestedFault& fault, const std::string& text) {
  const std::size_t digits = text.find_last_not_of("0123456789") + 1;
  const std::string name = text.substr(0, digits);
  const bool numbered = digits < text.size();
  const auto found = std::find_if(signals.begin(), signals.end(), [&](const SignalWords& words) {
    return name == words.one || (!numbered && name == words.all);
  });
  if (found == signals.end()) {
    throw SetupError("'" + text + "' is no signal" +
                     did_you_mean(name, list_of(signals, numbered ? &SignalWords::one : &SignalWords::all)));
  }
  fault.signal = found->signal;
  fault.index.reset();
  if (!numbered) return;
  int number = 0;
  std::from_chars(text.data() + digits, text.data() + text.size(), number);
  fault.index = number - 1;
}

std::vector<std::string> fault_kinds() { return list_of(kinds, &KindWords::name); }

FaultKind fault_kind(const std::string& text) {
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const KindWords& each) { return each.name == text; });
  if (found != kinds.end()) return found->kind;
  throw SetupError("'" + text + "' is no kind of fault" + did_you_mean(text, fault_kinds()));
}

RequestedFault parse_fault(const std::string& text, const ParallelRobot& robot) {
  const std::size_t colon = text.find(':');
  const std::size_t at = text.find('@', colon == std::string::npos ? 0 : colon);
  if (colon == std::string::npos || at == std::string::npos) {
    refuse(text, {"it must be SIGNAL:KIND@TIME[:SIZE], such as encoder2:drifting@0.5:-5"});
  }
  const std::size_t second = text.find(':', at);
  RequestedFault fault;
  try {
    set_signal(fault, text.substr(0, colon));
    fault.kind = fault_kind(text.substr(colon + 1, at - colon - 1));
  } catch (const SetupError& error) {
    refuse(text, error.problems());
  }
  const double begin = number_in(text, text.substr(at + 1, second - at - 1), "time");
  if (!(begin >= 0.0 && begin <= 3600.0)) refuse(text, {"the time must be between 0 and 3600 s"});
  fault.begin = from_seconds(begin);
  if (second != std::string::npos) fault.size = number_in(text, text.substr(second + 1), "size");
  const std::vector<std::string> found = problems(fault, robot);
  if (!found.empty()) refuse(text, found);
  return fault;
}

std::string text_of(const RequestedFault& fault) {
  std::string text =
      name_of(fault) + ":" + std::string(words_of(fault.kind).name) + "@" + seconds_text(fault.begin);
  if (fault.size) text += ":" + short_number(*fault.size);
  return text;
}

}  // namespace flinch
