#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "tests/support/other_program.h"
#include "tests/support/workplace.h"

namespace flinch::test {

using Files = std::map<std::string, std::string>;  ///< names and bytes

/// A verb of the program, with the arguments that make an older result and a newer one in the same folder.
struct InterruptedVerb {
  std::vector<std::string> older, newer;
};

/// The results of a verb, older and newer, and whether what lies in their folder is one of them.
class VerbResults {
 public:
  /// `folder`: of the results; made where it is not there.
  explicit VerbResults(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// A run of 0.6 s, a campaign of six such runs, thresholds of one estimator in a recording of 33 s.
  InterruptedVerb run() const;
  InterruptedVerb campaign() const;
  InterruptedVerb calibrate() const;

  /// Makes the newer result, then the older one, which stays.
  void make_both(const InterruptedVerb& verb);
  /// Makes the older one once more; nothing else may be there then.
  void make_older(const InterruptedVerb& verb);

  /// Each file of the older result is there, and each that is there is the older or the newer one, from its
  /// first byte to its last, but for what a program that was stopped may leave besides.
  void expect_one_of_both() const;
  std::size_t leftovers() const;

  /// What is in the folder.
  Files files() const;
  Time takes() const { return takes_; }  ///< of a call

 private:
  void make(const std::vector<std::string>& arguments);
  void expect_whole(const std::string& name, const std::string& bytes) const;
  std::string scenario(const std::string& shipped, double duration) const;

  Workplace place_;
  std::filesystem::path folder_;
  Files older_, newer_;
  std::size_t samples_ = 0;
  Time takes_{};
};

}  // namespace flinch::test
