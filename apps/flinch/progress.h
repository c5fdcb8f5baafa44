#pragma once

#include <chrono>
#include <string>

namespace flinch {

/// Tells on stderr how far something has come: a bar that redraws itself on a terminal; where stderr is a
/// pipe or file, a plain line at every quarter. Both say how long the rest will take. Says nothing when
/// quiet. The clock is the wall's, and nothing but the display depends on it.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `share` of the work is done, 0 ... 1; `share_before` of it was so before this program began.
  void show(double share, double share_before = 0.0);

 private:
  void draw_bar(double share, const std::string& time_left);
  void print_line(double share, const std::string& time_left);

  std::string what_;
  bool quiet_;
  bool terminal_;
  int quarters_ = 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point last_drawn_;
};

/// "2 h 05 min left": how long the rest takes where `share_before` ... `share` took `elapsed` [s]; "" where
/// too little was done to tell.
std::string time_left(double elapsed, double share, double share_before = 0.0);

}  // namespace flinch
