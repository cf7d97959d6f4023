#include "estimation/page/report_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

TEST(ReportPage, HoldsTextEscapedTablesAndPictures) {
  const testing::ScratchFolder folder;
  const auto file = folder / "index.html";
  std::ofstream(folder / "fit.png") << "Man!";  // the page does not look into a picture
  write_report_page({"<b>&\"", "One sentence.", {}, {{{"a", "b"}, {{"1", "2"}}}}, {{"fit.png", "the fit"}}},
                    file);
  std::ifstream stream(file);
  const std::string html{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(html.find("<h1>&lt;b&gt;&amp;&quot;</h1>"), std::string::npos);
  EXPECT_NE(html.find("<tr><th>a</th><th>b</th></tr>\n<tr><td>1</td><td>2</td></tr>"), std::string::npos);
  EXPECT_NE(html.find("<img src=\"data:image/png;base64,TWFuIQ==\" alt=\"the fit\">"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos) << "nothing is fetched from elsewhere";
}

}  // namespace
}  // namespace astrolith
