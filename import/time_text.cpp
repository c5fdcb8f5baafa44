#include "import/time_text.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>

#include "import/number_text.h"

namespace flinch {
namespace {

constexpr std::int64_t second = 1'000'000'000;

/// Reads a text from its begin on.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool ended() const { return rest_.empty(); }
  char front() const { return rest_.empty() ? '\0' : rest_.front(); }
  bool take(char letter) {
    if (front() != letter) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// A whole number of at most so many digits.
  std::optional<int> number(std::size_t most_digits) {
    std::size_t digits = 0;
    while (digits < rest_.size() && digits < most_digits && rest_[digits] >= '0' && rest_[digits] <= '9')
      ++digits;
    int value = 0;
    if (digits == 0) return std::nullopt;
    std::from_chars(rest_.data(), rest_.data() + digits, value);
    rest_.remove_prefix(digits);
    return value;
  }
  /// Digits of a fraction of a second [ns]; what is finer is left out.
  std::int64_t fraction() {
    std::int64_t value = 0, unit = second / 10;
    for (; front() >= '0' && front() <= '9'; unit /= 10) {
      value += unit * (front() - '0');
      rest_.remove_prefix(1);
    }
    return value;
  }
  void skip_blanks() {
    while (take(' ')) {
    }
  }
  /// "PM", whatever the case.
  bool take_word(std::string_view word) {
    if (rest_.size() < word.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i) {
      if ((rest_[i] | 0x20) != (word[i] | 0x20)) return false;
    }
    rest_.remove_prefix(word.size());
    return true;
  }

 private:
  std::string_view rest_;
};

/// Nanoseconds since 1970 at midnight.
std::optional<std::int64_t> day_of(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok() || year < 1900 || year > 2200) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count() * 86'400 * second;
}

/// Year first, or last behind the day (with dots) or the month (with strokes).
std::optional<std::int64_t> scan_date(Scanner& text) {
  const std::optional<int> first = text.number(4);
  const char between = text.front();
  if (!first || (between != '-' && between != '/' && between != '.') || !text.take(between))
    return std::nullopt;
  const std::optional<int> second_part = text.number(2);
  if (!second_part || !text.take(between)) return std::nullopt;
  const std::optional<int> third = text.number(4);
  if (!third) return std::nullopt;
  if (*first > 31) return day_of(*first, *second_part, *third);
  if (between == '/' && *second_part > 12) return day_of(*third, *first, *second_part);
  if (between == '/' && *first <= 12) return day_of(*third, *first, *second_part);
  return day_of(*third, *second_part, *first);
}

std::optional<std::int64_t> scan_time(Scanner& text) {
  const std::optional<int> hours = text.number(2);
  if (!hours || *hours > 24 || !text.take(':')) return std::nullopt;
  const std::optional<int> minutes = text.number(2);
  if (!minutes || *minutes > 59) return std::nullopt;
  std::int64_t time = (*hours * 3600LL + *minutes * 60LL) * second;
  if (text.take(':')) {
    const std::optional<int> seconds = text.number(2);
    if (!seconds || *seconds > 60) return std::nullopt;
    time += *seconds * second;
    if (text.take('.') || text.take(',') || text.take(':')) time += text.fraction();
  }
  text.skip_blanks();
  const bool afternoon = text.take_word("pm");
  if (afternoon && *hours < 12) time += 12 * 3600 * second;
  if (!afternoon && text.take_word("am") && *hours == 12) time -= 12 * 3600 * second;
  return time;
}

/// How far the zone is ahead of UTC; none: something else stands there.
std::optional<std::int64_t> scan_zone(Scanner& text) {
  text.skip_blanks();
  if (text.ended() || text.take('Z') || text.take_word("utc")) return 0;
  const bool ahead = text.front() == '+';
  if (!text.take('+') && !text.take('-')) return std::nullopt;
  const std::optional<int> hours = text.number(2);
  if (!hours) return std::nullopt;
  text.take(':');
  const std::int64_t offset = (*hours * 3600LL + text.number(2).value_or(0) * 60LL) * second;
  return ahead ? offset : -offset;
}

std::optional<std::int64_t> whole(std::int64_t instant, Scanner& text) {
  const std::optional<std::int64_t> zone = scan_zone(text);
  if (!zone || !text.ended()) return std::nullopt;
  return instant - *zone;
}

}  // namespace

std::optional<std::int64_t> clock_text(std::string_view text) {
  Scanner alone(text);
  if (const auto time = scan_time(alone)) return whole(*time, alone);
  Scanner scanner(text);
  const std::optional<std::int64_t> day = scan_date(scanner);
  if (!day) return std::nullopt;
  if (scanner.ended()) return day;
  if (!scanner.take('T') && !scanner.take(' ')) return std::nullopt;
  scanner.skip_blanks();
  const std::optional<std::int64_t> time = scan_time(scanner);
  if (!time) return std::nullopt;
  return whole(*day + *time, scanner);
}

std::optional<std::int64_t> decimal_instant(std::string_view text, char decimal, ClockUnit unit) {
  const bool negative = text.starts_with('-');
  std::string_view digits = text.substr(negative || text.starts_with('+') ? 1 : 0);
  const std::size_t point = std::min(digits.find(decimal), digits.size());
  const std::string_view before = digits.substr(0, point);
  std::string_view after = digits.substr(std::min(point + 1, digits.size()));
  std::int64_t whole = 0, fraction = 0;
  const auto scale = static_cast<std::int64_t>(unit);
  const auto [rest, error] = std::from_chars(before.data(), before.data() + before.size(), whole);
  bool simple = !before.empty() && error == std::errc{} && rest == before.data() + before.size() &&
                whole < std::numeric_limits<std::int64_t>::max() / scale - 1;
  std::int64_t place = scale;
  for (std::size_t i = 0; simple && i < after.size(); ++i) {
    simple = after[i] >= '0' && after[i] <= '9';
    // What is finer than a nanosecond is rounded.
    if (place == 1 && after[i] >= '5') ++fraction;
    place = place > 1 ? place / 10 : 0;
    fraction += place * (after[i] - '0');
  }
  if (simple) {
    const std::int64_t instant = whole * scale + fraction;
    return negative ? -instant : instant;
  }
  const std::optional<double> value = number_text(text, decimal);
  if (!value) return std::nullopt;
  const std::int64_t instant = instant_of(*value, unit);
  return instant == no_instant ? std::nullopt : std::optional(instant);
}

}  // namespace flinch
