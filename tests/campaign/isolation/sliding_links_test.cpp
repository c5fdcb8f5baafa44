// Where second links are touched by rough posts, of robots that differ from their model: place, force across
// the link, and how far the covariance covers them; while the link slides, and once it slides the other way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "systems/foundation/setup_error.h"
#include "systems/signals/wrench_estimate.h"
#include "tests/campaign/isolation/touched_bodies.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::quantile;

/// What a link and what touches it do at a sample, in the axes of the link.
struct Sliding {
  bool touched = false;
  double fraction = 0.0;
  double across = 0.0;    ///< force [N]
  double velocity = 0.0;  ///< of the link along itself, at the place [m/s]
  CartesianVector axis_across;
};

Sliding sliding_at(const test::Touched& run, std::size_t sample, int body) {
  Sliding now;
  const TouchTruth touch = run.at<ContactTruth>("contact", sample).strongest;
  if (touch.body != body) return now;
  const PlantTruth truth = run.at<PlantTruth>("truth", sample);
  Kinematics k;
  run.robot->kinematics(truth.pose, truth.velocity, k);
  const LinkContactMap link = link_contact_map(*run.robot, k, BodyId::from_index(body));
  const double along = link.axes.col(0).dot(touch.point_in_base - link.proximal_joint);
  now.touched = true;
  now.fraction = along / link.length;
  now.axis_across = link.axes.col(1);
  now.across = now.axis_across.dot(touch.force_in_base);
  now.velocity = (link.at_joint + now.fraction * link.along).col(0).dot(truth.velocity);
  return now;
}

/// Errors of one locator at one moment of many contacts.
struct Errors {
  std::vector<double> fraction, across;
  int located = 0, covered = 0, contacts = 0;

  void add(const ContactLocation& found, const Sliding& truth, int body) {
    ++contacts;
    if (!found.valid || found.body != body || !found.located) return;
    ++located;
    fraction.push_back(std::abs(found.fraction - truth.fraction));
    across.push_back(std::abs(truth.axis_across.dot(found.force_in_base) - truth.across));
    covered += fraction.back() < 1.96 * std::sqrt(found.covariance(0, 0));
  }
  void print(const char* locator, const char* moment) const {
    std::printf("| %s | %s | %d of %d | %.1f / %.1f %% | %.1f / %.1f N | %d of %d |\n", locator, moment,
                located, contacts, 100.0 * quantile(fraction, 0.5), 100.0 * quantile(fraction, 0.9),
                quantile(across, 0.5), quantile(across, 0.9), covered, located);
  }
};

/// The first sample at which the estimated force has 20 N.
std::size_t twenty_newton(const test::Touched& run) {
  for (std::size_t k = run.detection(); k < run.samples(); ++k)
    if (run.at<ContactClassification>("classification", k).valid &&
        run.at<PlantTruth>("truth", k).wrench_in_base.head<2>().norm() >= 20.0)
      return k;
  return run.samples();
}

TEST(SlidingLinks, AreLocated) {
  const Campaign campaign = read_campaign("apps/campaigns/sliding_links_oracle.yaml",
                                          {.draws = test::wanted<std::size_t>("FLINCH_CONTACTS", 400),
                                           .seed = test::wanted<std::uint64_t>("FLINCH_SEED", 41)});
  Errors form[2], particles[2];
  for (std::size_t number = 0; number < campaign.runs(); ++number) {
    try {
      const test::Touched run(draw_run(campaign, number).scenario);
      std::size_t sample = twenty_newton(run) + 10;
      if (sample >= run.samples()) continue;
      const int body = run.at<ContactTruth>("contact", sample).strongest.body;
      if (body <= 0 || !BodyId::from_index(body).is_link2()) continue;
      const Sliding first = sliding_at(run, sample, body);
      form[0].add(run.at<ContactLocation>("location", sample), first, body);
      particles[0].add(run.at<ContactLocation>("location_particle_filter", sample), first, body);
      while (sample < run.samples()) {
        const Sliding now = sliding_at(run, sample, body);
        if (!now.touched || now.velocity * first.velocity < 0.0) break;
        ++sample;
      }
      sample += 10;
      if (sample >= run.samples()) continue;
      const Sliding turned = sliding_at(run, sample, body);
      if (!turned.touched || std::abs(turned.across) < 10.0) continue;
      form[1].add(run.at<ContactLocation>("location", sample), turned, body);
      particles[1].add(run.at<ContactLocation>("location_particle_filter", sample), turned, body);
    } catch (const SetupError& error) {
      std::printf("  run %zu left out: %s\n", number, error.what());
    }
  }
  std::printf(
      "| locator | moment | located | place off by, median / 90 %% | force across | within 1.96 deviations "
      "|\n");
  const char* const moments[] = {"10 ms after 20 N", "10 ms after it turned round"};
  for (std::size_t i = 0; i < 2; ++i) {
    form[i].print("closed form", moments[i]);
    particles[i].print("particles", moments[i]);
    ASSERT_GT(form[i].located, 20);
    EXPECT_GT(form[i].covered, 0.9 * form[i].located);
    EXPECT_GT(particles[i].covered, 0.9 * particles[i].located);
  }
  EXPECT_LT(quantile(form[0].fraction, 0.5), 0.06);
  EXPECT_LT(quantile(form[1].fraction, 0.5), 0.04);
}

}  // namespace
}  // namespace flinch
