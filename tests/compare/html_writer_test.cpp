// SPDX-License-Identifier: Apache-2.0
#include "host/compare/html_writer.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

TEST(HtmlWriter, EncodesTheVectorsOfRfc4648) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64(std::string("\xff\xfe\x00\x80", 4)), "//4AgA==");
}

TEST(HtmlWriter, EscapesTextAndAttributes) {
    HtmlWriter html("a < b & \"c\"", "");
    html.element("p", "<script>'&'</script>", {{"title", "\"><b>"}});
    const std::string page = html.finish();
    EXPECT_NE(page.find("<title>a &lt; b &amp; &quot;c&quot;</title>"), std::string::npos);
    EXPECT_NE(page.find("<p title=\"&quot;&gt;&lt;b&gt;\">&lt;script&gt;&#39;&amp;&#39;&lt;/script&gt;</p>"),
              std::string::npos);
}

TEST(HtmlWriter, ClosesWhatIsOpen) {
    HtmlWriter html("t", "");
    html.open("div").open("table").open("tr");
    const std::string page = html.finish();
    EXPECT_TRUE(page.ends_with("</tr>\n</table>\n</div>\n</body>\n</html>\n"));
}

TEST(HtmlWriter, EmbedsFiles) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.png", std::ios::binary) << "foobar";
    HtmlWriter html("t", "");
    html.image(folder / "a.png", "image/png", "six letters", {{"class", "x"}});
    EXPECT_NE(html.finish().find(R"(<img src="data:image/png;base64,Zm9vYmFy" alt="six letters" class="x">)"),
              std::string::npos);
}

}  // namespace
}  // namespace nearlight::core
