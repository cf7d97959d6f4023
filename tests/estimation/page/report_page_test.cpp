#include <fstream>
#include <stdexcept>

#include "estimation/page/page_internal.h"
#include "estimation/page/report_page.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

TEST(ReportPage, HoldsTextEscapedTablesAndPictures) {
  const testing::ScratchFolder folder;
  const auto file = folder / "index.html";
  std::ofstream(folder / "fit.png") << "Man!";  // the page does not look into a picture
  write_report_page({"<b>&\"", "One sentence.", {}, {{{"a", "b"}, {{"1", "2"}}}}, {{"fit.png", "the fit"}}},
                    file);
  const std::string html = testing::read_text(file);
  EXPECT_NE(html.find("<h1>&lt;b&gt;&amp;&quot;</h1>"), std::string::npos);
  EXPECT_NE(html.find("<tr><th>a</th><th>b</th></tr>\n<tr><td>1</td><td>2</td></tr>"), std::string::npos);
  EXPECT_NE(html.find("<img src=\"data:image/png;base64,TWFuIQ==\" alt=\"the fit\">"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos) << "nothing is fetched from elsewhere";
}

TurnableSurface triangle(const std::string& caption) {
  return {caption, {{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}}, {}};
}

TEST(TurnableSurfaces, HoldSixteenBitSteps) {
  const std::string html = turnable_surfaces_html({{triangle("a"), triangle("b"), "", "", ""}});
  // The cube has the centre (1, .5, 0) and the half width 1.
  const std::vector<std::int16_t> steps{-32767, -16384, 0, 32767, -16384, 0, -32767, 16384, 0};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(steps.data());
  EXPECT_NE(html.find("positions: \"" + base64({bytes, 2 * steps.size()}) + '"'), std::string::npos);
  EXPECT_NE(html.find("triangles: \"AAABAAIA\""), std::string::npos);
  EXPECT_EQ(html.find("colors: \""), std::string::npos);
}

TEST(TurnableSurfaces, CaptionsAreEscapedAndScriptsEndWhereTheyShould) {
  const std::string html = turnable_surfaces_html({{triangle("</script>"), triangle("b"), "<i>", "0", "1"}});
  EXPECT_NE(html.find("&lt;/script&gt;"), std::string::npos);
  EXPECT_NE(html.find("&lt;i&gt;"), std::string::npos);
  std::size_t opened = 0, closed = 0;
  for (std::size_t i = 0; (i = html.find("<script>", i)) != std::string::npos; ++i) ++opened;
  for (std::size_t i = 0; (i = html.find("</script>", i)) != std::string::npos; ++i) ++closed;
  EXPECT_EQ(opened, 2u);
  EXPECT_EQ(closed, 2u);
}

TEST(TurnableSurfaces, AreNeitherEmptyNorTooLarge) {
  TurnableSurface large = triangle("large");
  large.mesh.vertices.resize(kMostPageVertices + 1);
  EXPECT_THROW(turnable_surfaces_html({{triangle("a"), large, "", "", ""}}), std::invalid_argument);
  EXPECT_THROW(turnable_surfaces_html({{triangle("a"), {}, "", "", ""}}), std::invalid_argument);
  TurnableSurface uncolored = triangle("colours of two vertices");
  uncolored.rgb.resize(6);
  EXPECT_THROW(turnable_surfaces_html({{uncolored, triangle("b"), "", "", ""}}), std::invalid_argument);
}

TEST(PageText, Base64IsThatOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(TurnableSurfaces, ShareTheirViewer) {
  const TurnableSurfaces pair{triangle("a"), triangle("b"), "", "", ""};
  const std::string one = turnable_surfaces_html({pair}), two = turnable_surfaces_html({pair, pair});
  EXPECT_NE(two.find("id=\"turnable1\""), std::string::npos);
  EXPECT_LT(two.size() - one.size(), 4000u);  // the viewer is there once
  EXPECT_EQ(turnable_surfaces_html({}), "");
}

}  // namespace
}  // namespace astrolith
