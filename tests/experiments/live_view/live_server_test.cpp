#include "experiments/live_view/live_server.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "experiments/live_view/live_feed.h"
#include "systems/foundation/setup_error.h"
#include "tests/experiments/live_view/loopback_connection.h"

namespace flinch {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class LiveServerTest : public testing::Test {
 protected:
  std::string get(const std::string& path, const std::string& host) const {
    return answer(where, "GET " + path, host);
  }
  std::string get(const std::string& below) const { return get(where.root + below, where.host); }

  std::string order(const std::string& text) const {
    return answer(where, "POST " + where.root + "order", where.host,
                  "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
  }

  /// Somebody who has asked for the feed.
  std::unique_ptr<LoopbackConnection> viewer(int receives = 0) const {
    auto connection = std::make_unique<LoopbackConnection>(where.port, receives);
    connection->send("GET " + where.root + "feed HTTP/1.1\r\nHost: " + where.host + "\r\n\r\n");
    return connection;
  }

  static bool comes_true(const std::function<bool()>& what, milliseconds longest = milliseconds(10'000)) {
    const auto end = steady_clock::now() + longest;
    while (!what() && steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(5));
    return what();
  }

  LiveFeed feed{100, 64'000'000};
  std::vector<std::string> orders;
  LiveServer server{feed,
                    [this](std::string_view text) {
                      orders.emplace_back(text);
                      return text == "pause";
                    },
                    {.port = 0, .viewers = 3, .stall = milliseconds(300)}};
  LiveAddress where{server.address()};
};

/// "HTTP/1.1 403 Forbidden" with no body, and nothing that tells of the run.
void expect_refused(const std::string& said) {
  EXPECT_THAT(said, StartsWith("HTTP/1.1 403 "));
  EXPECT_THAT(said, HasSubstr("Content-Length: 0\r\n"));
  EXPECT_TRUE(said.ends_with("\r\n\r\n")) << said;
  EXPECT_THAT(said, Not(HasSubstr("Access-Control")));
}

TEST_F(LiveServerTest, ShowsThePageToWhoNamesTheToken) {
  server.show_page("<p>here</p>");
  const std::string said = get("");
  EXPECT_THAT(said, StartsWith("HTTP/1.1 200 "));
  EXPECT_TRUE(said.ends_with("<p>here</p>")) << said;
  EXPECT_THAT(said, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(said, HasSubstr("Cache-Control: no-store"));
  EXPECT_THAT(said, Not(HasSubstr("Access-Control")));
}

TEST_F(LiveServerTest, HasAnotherTokenOf128BitsEachTime) {
  std::set<std::string> roots;
  for (int i = 0; i < 20; ++i) {
    const LiveServer other(feed, {});
    const std::string root = LiveAddress(other.address()).root;
    EXPECT_EQ(root.size(), 34U);
    EXPECT_EQ(root.find_first_not_of("0123456789abcdef/"), std::string::npos);
    roots.insert(root);
  }
  EXPECT_EQ(roots.size(), 20U);
}

TEST_F(LiveServerTest, RefusesWhoDoesNotNameTheToken) {
  server.show_page("<p>here</p>");
  server.show_report("<p>report</p>");
  std::string nearly = where.root;
  nearly[5] = nearly[5] == '0' ? '1' : '0';
  for (const std::string& path :
       {std::string("/"), std::string("/feed"), std::string("/report.html"), std::string("/order"),
        where.root.substr(0, 33), where.root.substr(0, 20), nearly, nearly + "feed", "/x" + where.root,
        "/.." + where.root + "x", "/?" + where.root}) {
    expect_refused(get(path, where.host));
    expect_refused(answer(where, "POST " + path, where.host, "Content-Length: 5\r\n\r\npause"));
    expect_refused(answer(where, "OPTIONS " + path, where.host));
  }
  EXPECT_TRUE(orders.empty());
}

TEST_F(LiveServerTest, RefusesWhoCameByAnotherNameOfTheHost) {
  server.show_page("<p>here</p>");
  const std::string port = ":" + std::to_string(where.port);
  for (const std::string& host :
       {std::string("rebound.example") + port, std::string("127.0.0.1"), "127.0.0.2" + port,
        "127.0.0.1.example" + port, std::string("127.0.0.1:1"), std::string()}) {
    expect_refused(get(where.root, host));
    expect_refused(get(where.root + "feed", host));
  }
  expect_refused(answer(where, "GET " + where.root, where.host, "Host: rebound.example\r\n"));
  EXPECT_THAT(get(where.root, "localhost" + port), StartsWith("HTTP/1.1 200 "));
}

TEST_F(LiveServerTest, ListensOnTheLoopbackInterfaceAlone) {
  EXPECT_THAT(server.address(), StartsWith("http://127.0.0.1:"));
  EXPECT_THROW(LiveServer(feed, {}, {.port = where.port}), SetupError);
}

TEST_F(LiveServerTest, HasNothingBesidePageFeedOrderAndReport) {
  EXPECT_THAT(get("nothing"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(get("../etc/passwd"), StartsWith("HTTP/1.1 404 "));
  EXPECT_THAT(get("report.html"), StartsWith("HTTP/1.1 404 ")) << "before there is one";
  server.show_report("<p>report</p>");
  EXPECT_TRUE(get("report.html").ends_with("<p>report</p>"));
  EXPECT_EQ(server.reports_fetched(), 1U);
}

TEST_F(LiveServerTest, FollowsOrdersAndSaysWhichAreNone) {
  EXPECT_THAT(order("pause"), StartsWith("HTTP/1.1 204 "));
  EXPECT_THAT(order("fly"), StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(order(std::string(10'000, 'x')), StartsWith("HTTP/1.1 413 "));
  EXPECT_EQ(orders, (std::vector<std::string>{"pause", "fly"}));
  EXPECT_THAT(answer(where, "GET " + where.root + "order", where.host), StartsWith("HTTP/1.1 404 "));
}

TEST_F(LiveServerTest, SendsEveryMessageToEveryViewer) {
  feed.publish("before");
  const auto one = viewer();
  const auto other = viewer();
  EXPECT_THAT(one->read_until("before\n\n"), HasSubstr("text/event-stream"));
  feed.publish("after");
  EXPECT_THAT(one->read_until("after\n\n"), HasSubstr("data: after\n\n"));
  const std::string both = other->read_until("after\n\n");
  EXPECT_THAT(both, HasSubstr("data: before\n\n"));
  EXPECT_THAT(both, HasSubstr("data: after\n\n"));
  feed.close();
  EXPECT_TRUE(comes_true([&] { return server.viewers() == 0; }));
  EXPECT_EQ(server.viewers_so_far(), 2U);
}

TEST_F(LiveServerTest, LetsNoMoreViewersInThanItMay) {
  std::vector<std::unique_ptr<LoopbackConnection>> all;
  for (int i = 0; i < 3; ++i) all.push_back(viewer());
  ASSERT_TRUE(comes_true([&] { return server.viewers() == 3; }));
  EXPECT_THAT(viewer()->read_all(), StartsWith("HTTP/1.1 503 "));
  all.pop_back();
  feed.publish("x");
  ASSERT_TRUE(comes_true([&] { return server.viewers() == 2; })) << "who has gone gives his place free";
  EXPECT_THAT(viewer()->read_until("data: x"), HasSubstr("data: x"));
}

TEST_F(LiveServerTest, DropsAViewerWhoTakesNothingAndHoldsUpNobodyForHim) {
  const auto stalled = viewer(4096);
  const auto one = viewer();
  const auto other = viewer();
  ASSERT_TRUE(comes_true([&] { return server.viewers() == 3; }));
  std::string read[2];
  std::thread reads_one([&] { read[0] = one->read_until("data: last"); });
  std::thread reads_other([&] { read[1] = other->read_until("data: last"); });
  const std::string message(400'000, 'm');
  auto longest = steady_clock::duration::zero();
  for (int i = 0; i < 60; ++i) {
    const auto before = steady_clock::now();
    feed.publish(message);
    longest = std::max(longest, steady_clock::now() - before);
    std::this_thread::sleep_for(milliseconds(20));
  }
  feed.publish("last");
  reads_one.join();
  reads_other.join();
  EXPECT_THAT(read[0], HasSubstr("data: last"));
  EXPECT_THAT(read[1], HasSubstr("data: last"));
  EXPECT_LT(longest, milliseconds(200)) << "less than he was waited for";
  EXPECT_TRUE(comes_true([&] { return server.viewers() == 2; })) << server.viewers() << " viewers";
}

TEST_F(LiveServerTest, AnswersWhileOthersConnectAndSayNothing) {
  server.show_page("<p>here</p>");
  std::vector<std::unique_ptr<LoopbackConnection>> silent;
  for (int i = 0; i < 30; ++i) silent.push_back(std::make_unique<LoopbackConnection>(where.port));
  EXPECT_THAT(get(""), StartsWith("HTTP/1.1 200 "));
}

}  // namespace
}  // namespace flinch
