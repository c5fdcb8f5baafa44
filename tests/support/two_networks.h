#pragma once

#include <string>

namespace flinch::test {

/// Two network namespaces with a cable between: a pair of virtual interfaces (veth), each called "flinch0".
/// Gone at the end. Needs the rights of an administrator and the program ip.
class TwoNetworks {
 public:
  TwoNetworks();
  TwoNetworks(const TwoNetworks&) = delete;
  TwoNetworks& operator=(const TwoNetworks&) = delete;
  ~TwoNetworks();

  /// Why there are none; empty where there are.
  const std::string& missing() const { return missing_; }

  const std::string& first() const { return first_; }
  const std::string& second() const { return second_; }
  static constexpr const char* interface = "flinch0";
  static constexpr const char* first_address = "10.203.7.1";
  static constexpr const char* second_address = "10.203.7.2";

  /// Takes down the second one's end of the cable.
  void cut() const;

 private:
  std::string first_;
  std::string second_;
  std::string missing_;
};

/// Makes this process part of a network namespace. Returns whether that worked.
bool enter_network(const std::string& network);

}  // namespace flinch::test
