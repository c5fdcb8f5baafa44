#include "systems/foundation/html_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flinch {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

TEST(HtmlPage, EscapesWhateverMeansSomethingThere) {
  EXPECT_EQ(escaped(R"(<b onclick='x' id="y">&amp;)"),
            "&lt;b onclick=&#39;x&#39; id=&quot;y&quot;&gt;&amp;amp;");
  EXPECT_EQ(escaped("0.5 N·m, Δq"), "0.5 N·m, Δq");
}

TEST(HtmlPage, BeginsWithAHeadThatForbidsScriptsAndOtherFiles) {
  const std::string head = page_head("</title><script>", "body{margin:0}");
  EXPECT_THAT(head, HasSubstr("default-src 'none'"));
  EXPECT_THAT(head, Not(HasSubstr("script-src")));
  EXPECT_THAT(head, HasSubstr("<title>&lt;/title&gt;&lt;script&gt;</title>"));
  EXPECT_THAT(head, HasSubstr("body{margin:0}"));
  EXPECT_THAT(head, EndsWith("<body>\n"));
}

}  // namespace
}  // namespace flinch
