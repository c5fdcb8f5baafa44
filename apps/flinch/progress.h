#pragma once

#include <chrono>
#include <string>

namespace flinch {

/// Tells on stderr how far something has come: a bar that redraws itself on a terminal; where stderr is a
/// pipe or file, a plain line at every quarter. Says nothing when quiet. The clock is the wall's and only
/// paces the display.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// `share` of the work is done, 0 ... 1.
  void show(double share);

 private:
  void draw_bar(double share);
  void print_line(double share);

  std::string what_;
  bool quiet_;
  bool terminal_;
  int quarters_ = 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace flinch
