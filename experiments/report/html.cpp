#include "experiments/report/html.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace experiments::report {
namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2420; --soft: #5b6660; --paper: #fbfbf9; --card: #ffffff;
  --line: #dfe3df; --bar: #2f7d5b; --bar2: #b9c7bf; --mark: #13251c; --bad: #b3261e; --best: #1d6b47; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e9e5; --soft: #9aa69f; --paper: #141815;
  --card: #1c211d; --line: #313a34; --bar: #4fae84; --bar2: #56635c; --mark: #eef5f0; --bad: #ff8a80;
  --best: #7fd6ab; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 76rem; padding: 1.5rem 1rem 4rem; background: var(--paper);
  color: var(--ink); font: 16px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.7rem; margin: 0; } h2 { font-size: 1.25rem; margin: 2.5rem 0 .75rem; }
h3 { font-size: 1rem; margin: 1.5rem 0 .5rem; color: var(--soft); font-weight: 600; }
p { margin: .25rem 0; } .soft { color: var(--soft); } .bad { color: var(--bad); }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line);
  border-radius: .5rem; }
.scroll + .scroll { margin-top: 1rem; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td { padding: .4rem .75rem; text-align: right; border-bottom: 1px solid var(--line);
  white-space: nowrap; font-variant-numeric: tabular-nums; }
tr:last-child td { border-bottom: 0; } th { font-weight: 600; color: var(--soft); }
th:first-child, td:first-child { text-align: left; }
td .spread { display: block; font-size: .75rem; font-weight: 400; color: var(--soft); }
td.best { color: var(--best); font-weight: 600; }
table.matrix :is(th, td) { text-align: left; }
td.pass { background: color-mix(in srgb, var(--best) 18%, transparent); }
td.fail { background: color-mix(in srgb, var(--bad) 22%, transparent); }
table.facts td { text-align: left; white-space: normal; overflow-wrap: anywhere; }
table.facts td:first-child { color: var(--soft); white-space: nowrap; vertical-align: top; }
.charts { display: grid; gap: 1rem; margin: 1rem 0;
  grid-template-columns: repeat(auto-fit, minmax(min(20rem, 100%), 1fr)); }
.charts svg { width: 100%; max-width: 36rem; height: auto; background: var(--card);
  border: 1px solid var(--line); border-radius: .5rem; }
svg text { fill: var(--ink); font: 12px system-ui, "DejaVu Sans", sans-serif; }
svg .title { font-weight: 600; font-size: 13px; } svg .value { text-anchor: end; }
svg .bar { fill: var(--bar); } svg .track { fill: var(--bar2); opacity: .25; }
svg .spread { stroke: var(--mark); stroke-width: 1.5; fill: none; } svg .thick { stroke-width: 4; }
svg.pareto { display: block; width: 100%; min-width: 44rem; height: auto; }
svg .middle { text-anchor: middle; } svg .soft, svg .tick { fill: var(--soft); }
svg .tick { font-size: 11px; } svg .grid { stroke: var(--line); }
svg .zero { stroke: var(--soft); stroke-dasharray: 5 4; }
svg .label { font-size: 11px; fill: var(--soft); paint-order: stroke; stroke: var(--card);
  stroke-width: 3px; } svg .strong { fill: var(--ink); font-weight: 600; }
svg .leader { stroke: var(--soft); stroke-width: .75; }
svg .front { fill: none; stroke: var(--mark); stroke-width: 1.5; opacity: .6; }
svg .mark { fill: var(--c); stroke: var(--c); stroke-width: 1.75; } svg .open { fill: var(--card); }
svg .curve { fill: none; stroke: var(--c); stroke-width: 1.75; }
svg .span { stroke: var(--c); stroke-width: 1.5; opacity: .5; }
svg:root { background: var(--card); } svg.pareto:root { min-width: 0; }
.s0 { --c: #2f7d5b; } .s1 { --c: #0072b2; } .s2 { --c: #d55e00; } .s3 { --c: #9a4f8c; }
.s4 { --c: #b08900; } .s5 { --c: #3aa0d8; } .s6 { --c: #7a5230; } .s7 { --c: #777f86; }
@media (prefers-color-scheme: dark) { .s0 { --c: #4fae84; } .s1 { --c: #4da6e0; }
  .s2 { --c: #f08a3c; } .s3 { --c: #cc79a7; } .s4 { --c: #e3b93a; } .s5 { --c: #8fd0f5; }
  .s6 { --c: #b98a60; } .s7 { --c: #a3abb2; } }
.pictures { display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(min(22rem, 100%), 1fr)); }
figure { margin: 0; } figure img { width: 100%; height: auto; border-radius: .5rem;
  border: 1px solid var(--line); display: block; }
figcaption { font-size: .85rem; color: var(--soft); padding-top: .25rem; }
pre { overflow-x: auto; background: var(--card); border: 1px solid var(--line); padding: .75rem;
  border-radius: .5rem; font-size: .8rem; }
)css";

std::string base64(std::string_view bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace

std::string escape(std::string_view text) {
    std::string out;
    for (char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string shortened(const std::string& text, std::size_t longest) {
    if (text.size() <= longest) return text;
    std::size_t end = longest;
    while (end > 0 && (text[end] & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "…";
}

std::string png_data_uri(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    return "data:image/png;base64," + base64(bytes);
}

std::string standalone_svg(const std::string& svg) {
    const std::size_t inside = svg.find('>') + 1;
    return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + svg.substr(4, inside - 4) + "<style>" +
           kStyle + "</style>" + svg.substr(inside);
}

std::string document_head(const std::string& title) {
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           escape(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n";
}

}  // namespace experiments::report
