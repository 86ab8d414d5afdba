// The report, opened in a browser.
#include <gmock/gmock.h>

#include <cstdlib>

#include "experiments/image/image.hpp"
#include "tests/experiments/cli/process.hpp"

namespace tests {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ReportTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        write_config("[[method]]\nname = \"rival\"\nflip = 5\nheat = true\n");
        ASSERT_EQ(fake("run test.toml --quiet --out r").code, 0);
    }
    bool has_browser() { return shell("command -v chromium").code == 0; }
    Outcome browser(const std::string& arguments) {
        return shell(
            "timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-quic "
            "--no-first-run --disable-background-networking --disable-component-update "
            "--disable-sync --user-data-dir=profile --virtual-time-budget=5000 " +
            arguments);
    }
};

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++n;
    return n;
}

TEST_F(ReportTest, NeedsNothingElse) {
    const std::string html = read_text(folder_ / "r/report.html");
    EXPECT_EQ(count(html, "http://") + count(html, "https://"), 0u);
    EXPECT_EQ(count(html, "<script"), 0u);
    EXPECT_EQ(count(html, "src=\""), count(html, "src=\"data:image/png;base64,"));
}

TEST_F(ReportTest, IsMadeAgainFromTheData) {
    const std::string before = read_text(folder_ / "r/report.html");
    fs::remove(folder_ / "r/report.html");
    const Outcome report = fake("report r");
    EXPECT_EQ(report.code, 0) << report.err;
    EXPECT_EQ(read_text(folder_ / "r/report.html"), before);
    expect_error(fake("report none"), 1, {"none/manifest.json"});
}

TEST_F(ReportTest, LabelsCannotBreakThePage) {
    ASSERT_EQ(fake("run test.toml --quiet --out s --set 'method.0.variant=<b>&\"x' "
                   "--set 'scene.0.name=</table>'")
                  .code,
              0);
    const std::string html = read_text(folder_ / "s/report.html");
    EXPECT_THAT(html, HasSubstr("&lt;b&gt;&amp;"));
    EXPECT_EQ(count(html, "<b>"), 0u);
    EXPECT_EQ(count(html, "<table"), count(html, "</table>"));
}

TEST_F(ReportTest, ShowsTablesBarsAndPicturesInABrowser) {
    if (!has_browser()) GTEST_SKIP() << "chromium is not installed: the report was not opened";
    // A copy with a probe that writes what the browser made of the page into the page.
    std::string html = read_text(folder_ / "r/report.html");
    const std::string probe =
        "<pre id=\"probe\"></pre><script>onload = () => { const q = s => [...document."
        "querySelectorAll(s)]; document.getElementById('probe').textContent = ["
        "q('table.results tr').length, q('img').length,"
        "q('img').filter(i => i.naturalWidth > 0).length,"
        "q('rect.bar').filter(b => b.getBoundingClientRect().width > 1).length,"
        "q('svg.pareto title').length,"
        "document.documentElement.scrollWidth <= innerWidth ? 'fits' : 'too wide'].join(' ');"
        "};</script></body>";
    html.replace(html.find("</body>"), 7, probe);
    write_text(folder_ / "probe.html", html);
    for (const char* size : {"1280,900", "500,900"}) {
        const Outcome page = browser(std::string("--window-size=") + size + " --dump-dom 'file://" +
                                     (folder_ / "probe.html").string() + "'");
        // Header and two rows; shaded, visibility, errors of both, heat; 4 charts of 2 bars; 2
        // marks of run time against error.
        EXPECT_THAT(page.out, HasSubstr("<pre id=\"probe\">3 5 5 8 2 fits</pre>")) << page.err;
    }
}

TEST_F(ReportTest, TheScreenshotShowsBarsInTheirColour) {
    if (!has_browser()) GTEST_SKIP() << "chromium is not installed: the report was not opened";
    const Outcome shot =
        browser("--hide-scrollbars --window-size=1000,2400 --screenshot=shot.png 'file://" +
                (folder_ / "r/report.html").string() + "'");
    ASSERT_TRUE(fs::exists(folder_ / "shot.png")) << shot.err;
    const auto image = experiments::image::read_png(folder_ / "shot.png");
    using experiments::image::srgb_encode;
    int bar_pixels = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto byte = [&](int c) {
                return int(255 * srgb_encode(image.at(x, y, c)) + 0.5f);
            };
            bar_pixels += byte(0) == 0x2f && byte(1) == 0x7d && byte(2) == 0x5b;
        }
    EXPECT_GT(bar_pixels, 5000);
}

}  // namespace
}  // namespace tests
