#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>

namespace flinch::test {

/// A message as one line of text in which no bit of it is lost: what two programs compare.
class MessageText {
 public:
  template <std::integral Integer>
  void add(Integer number) {
    line_ << ' ' << +number;
  }
  void add(double number) { line_ << " 0x" << std::hex << std::bit_cast<std::uint64_t>(number) << std::dec; }
  void add(std::string_view text) { line_ << ' ' << std::quoted(text); }

  std::string line() const { return line_.str(); }

 private:
  std::ostringstream line_;
};

}  // namespace flinch::test
