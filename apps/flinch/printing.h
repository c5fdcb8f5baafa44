#pragma once

#include <fmt/core.h>

#include <string_view>
#include <utility>

namespace flinch {

/// Everything that the program says goes through these functions. None of them throws where a stream takes
/// no more: a message is lost then, and the work goes on. Text that comes from files is shown and not obeyed,
/// see visible_text().

/// Prints results on stdout; require_printed() says whether that went well.
void print_results(std::string_view text);
template <class... Values>
void print_result(fmt::format_string<Values...> format, Values&&... values) {
  print_results(fmt::format(format, std::forward<Values>(values)...));
}

/// Prints messages on stderr.
void print_messages(std::string_view text) noexcept;
template <class... Values>
void print_message(fmt::format_string<Values...> format, Values&&... values) {
  print_messages(fmt::format(format, std::forward<Values>(values)...));
}

/// Removes what stands in the line of a terminal, on stderr.
void clear_line() noexcept;
/// Shows at once what was written to stderr.
void flush_messages() noexcept;
/// Hands results on, so that they stand before the messages that follow.
void flush_results();

/// Throws SetupError where any result was lost since the last call.
void require_printed();

}  // namespace flinch
