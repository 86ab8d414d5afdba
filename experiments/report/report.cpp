#include "experiments/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "experiments/measure/metrics.hpp"
#include "experiments/measure/run_folder.hpp"
#include "experiments/measure/session.hpp"
#include "experiments/measure/summary.hpp"
#include "experiments/report/charts.hpp"
#include "experiments/report/frames.hpp"
#include "experiments/report/html.hpp"
#include "experiments/report/pareto.hpp"
#include "experiments/report/stability.hpp"

namespace experiments::report {
namespace {

using measure::MetricSummary;
using measure::ResultSummary;
using Results = std::vector<ResultSummary>;

constexpr const char* kCharted[] = {"build_ms", "query_ms", "total_ms", "sah_cost", "memory_bytes"};

struct SceneResults {
    std::string name;
    Results methods{};
    std::optional<ResultSummary> facts{};  ///< the rows about the scene itself
};

/// In the order of their first rows.
std::vector<SceneResults> by_scene(std::span<const ResultSummary> results) {
    std::vector<SceneResults> scenes;
    for (const ResultSummary& result : results) {
        auto scene = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const auto& s) { return s.name == result.scene; });
        if (scene == scenes.end()) scene = scenes.insert(scene, SceneResults{result.scene});
        if (result.method == measure::kSceneRows)
            scene->facts = result;
        else
            scene->methods.push_back(result);
    }
    return scenes;
}

/// Metrics that any of the results has: first the known ones in the list's order.
std::vector<std::string> columns(const Results& results) {
    std::vector<std::string> names;
    const auto add = [&](std::string_view name) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
    };
    for (const measure::Metric& metric : measure::metrics())
        for (const ResultSummary& result : results)
            if (result.find(metric.name)) add(metric.name);
    for (const ResultSummary& result : results)
        for (const MetricSummary& summary : result.metrics) add(summary.metric);
    return names;
}

bool is_best(const Results& results, const std::string& metric, double median) {
    const measure::Metric* known = measure::find_metric(metric);
    if (!known || known->better == measure::Better::neither || results.size() < 2) return false;
    const double sign = known->better == measure::Better::lower ? 1 : -1;
    bool differs = false;
    for (const ResultSummary& result : results) {
        const MetricSummary* other = result.find(metric);
        if (!other) continue;
        if (sign * other->statistics.median < sign * median) return false;
        differs = differs || other->statistics.median != median;
    }
    return differs;
}

std::string cell(const Results& results, const std::string& metric, const ResultSummary& result) {
    const MetricSummary* summary = result.find(metric);
    if (!summary) return "<td>–</td>";
    const auto& s = summary->statistics;
    std::string spread;
    if (s.min != s.max)
        spread = fmt::format("<span class=\"spread\">{} – {}</span>",
                             escape(measure::readable(s.min, summary->unit)),
                             escape(measure::readable(s.max, summary->unit)));
    return fmt::format("<td{}>{}{}</td>",
                       is_best(results, metric, s.median) ? " class=\"best\"" : "",
                       escape(measure::readable(s.median, summary->unit)), spread);
}

std::string table(const Results& results) {
    const std::vector<std::string> names = columns(results);
    std::string html = "<div class=\"scroll\"><table class=\"results\">\n<tr><th>method</th>";
    for (const std::string& name : names) {
        const measure::Metric* metric = measure::find_metric(name);
        html += fmt::format("<th title=\"{}\">{}</th>", metric ? escape(metric->meaning) : "",
                            escape(name));
    }
    html += "</tr>\n";
    for (const ResultSummary& result : results) {
        html += "<tr><td>" + escape(result.label()) + "</td>";
        for (const std::string& name : names) html += cell(results, name, result);
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

std::string charts(const Results& results) {
    std::string html;
    for (const char* name : kCharted) {
        std::vector<Bar> bars;
        std::string unit;
        for (const ResultSummary& result : results) {
            const MetricSummary* summary = result.find(name);
            if (!summary) continue;
            bars.push_back({result.label(), summary->statistics});
            unit = summary->unit;
        }
        if (bars.empty()) continue;
        const measure::Metric* metric = measure::find_metric(name);
        html += bar_chart(fmt::format("{}: {}", name, metric->meaning), unit, bars);
    }
    return html.empty() ? html : "<div class=\"charts\">\n" + html + "</div>\n";
}

/// The plot in the page, and as a file for other pages.
std::string pareto(const std::filesystem::path& run, const std::string& scene,
                   std::span<const Tradeoff> tradeoffs) {
    if (tradeoffs.size() < 2) return {};
    const std::string svg = pareto_chart(scene + ": run time against error", tradeoffs);
    std::filesystem::create_directories(run / "images");  // recorded runs may lack it
    measure::write_text(run / "images" / (measure::file_name(scene) + "-pareto.svg"),
                        standalone_svg(svg));
    return "<div class=\"scroll\">\n" + svg +
           "</div>\n<p class=\"soft\">Line: the Pareto front. Filled marks: methods that claim "
           "to be exact. Through each mark: fastest to slowest repetition. Logarithmic; errors "
           "outside the rounding band alone.</p>\n";
}

/// What the reference method sees; of the others, where they differ from it, and what points cost.
std::string pictures(const std::filesystem::path& run, const nlohmann::json& manifest,
                     const std::string& scene) {
    std::string first, rest;
    bool any_errors = false;
    const std::string reference = manifest.at("config").value("reference", "");
    for (const auto& image : manifest.value("images", nlohmann::json::array())) {
        const std::string kind = image.at("kind"), method = image.at("method"),
                          variant = image.at("variant"), file = image.at("file");
        const bool common = kind == "shaded" || kind == "visibility";
        if (image.at("scene") != scene || !std::filesystem::exists(run / file)) continue;
        if (common && method + " " + variant != reference) continue;
        any_errors = any_errors || kind == "errors";
        (common ? first : rest) += fmt::format(
            "<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}: {} {}</figcaption></figure>\n",
            png_data_uri(run / file), escape(fmt::format("{} of {}", kind, scene)), escape(kind),
            escape(method), escape(variant));
    }
    if (first.empty() && rest.empty()) return {};
    const std::string legend =
        "<p class=\"soft\">errors: red falsely lit, blue falsely shadowed, "
        "yellow wrong within the rounding band; few are drawn as dots.</p>\n";
    return "<h3>Pictures</h3>\n" + (any_errors ? legend : std::string()) +
           "<div class=\"pictures\">\n" + first + rest + "</div>\n";
}

std::string facts_table(const std::vector<std::pair<std::string, std::string>>& facts) {
    std::string html = "<div class=\"scroll\"><table class=\"facts\">\n";
    for (const auto& [name, value] : facts)
        html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escape(name), escape(value));
    return html + "</table></div>\n";
}

std::string text_of(const nlohmann::json& object, const char* key) {
    if (!object.contains(key) || object[key].is_null()) return "unknown";
    return object[key].is_string() ? object[key].get<std::string>() : object[key].dump();
}

std::string provenance(const nlohmann::json& manifest) {
    const auto &device = manifest.at("device"), &host = manifest.at("host"),
               &program = manifest.at("program");
    const auto& last = manifest.at("sessions").back();
    return "<h2>Provenance</h2>\n" +
           facts_table(
               {{"device", text_of(device, "name")},
                {"driver", text_of(device, "driver")},
                {"subgroup size", text_of(device, "subgroup_size")},
                {"host", text_of(host, "cpu") + ", " + text_of(host, "cores") + " cores, " +
                             text_of(host, "system")},
                {"commit",
                 text_of(program, "git_commit") +
                     (program.value("git_dirty", nlohmann::json()) == true ? " with changes" : "")},
                {"compiler", text_of(program, "compiler") + " " + text_of(program, "flags")},
                {"command", text_of(last, "command_line")},
                {"started", text_of(manifest.at("sessions").front(), "start")},
                {"ended", text_of(last, "end")},
                {"sessions", std::to_string(manifest.at("sessions").size())},
                {"config sha256", text_of(manifest, "config_sha256")}}) +
           "<details><summary>Resolved config</summary><pre>" +
           escape(manifest.at("config").dump(2)) + "</pre></details>\n";
}

std::string failures(const nlohmann::json& manifest) {
    std::string html;
    for (const auto& line :
         manifest.at("sessions").back().value("failures", nlohmann::json::array()))
        html += "<p class=\"bad\">Failed: " + escape(line.get<std::string>()) + "</p>\n";
    return html;
}

/// Run time along the scene's path, if it has one.
std::string curves(std::span<const measure::Row> rows, const std::string& scene) {
    const std::vector<Curve> found = find_curves(rows, scene);
    if (found.empty()) return {};
    return "<div class=\"scroll\">\n" + frame_chart(scene + ": run time along the path", found) +
           "</div>\n";
}

std::string scene_section(const std::filesystem::path& run, const nlohmann::json& manifest,
                          const SceneResults& scene, std::span<const measure::Row> rows,
                          std::span<const Tradeoff> tradeoffs) {
    std::string html = "<section>\n<h2>" + escape(scene.name) + "</h2>\n";
    if (scene.facts) {
        std::vector<std::string> parts;
        for (const MetricSummary& summary : scene.facts->metrics)
            parts.push_back(summary.metric + " " +
                            measure::readable(summary.statistics.median, summary.unit));
        html += fmt::format("<p class=\"soft\">{}</p>\n",
                            escape(fmt::format("{}", fmt::join(parts, " · "))));
    }
    if (!scene.methods.empty())
        html += table(scene.methods) + curves(rows, scene.name) +
                pareto(run, scene.name, tradeoffs) + charts(scene.methods);
    return html + pictures(run, manifest, scene.name) + "</section>\n";
}

nlohmann::json read_manifest(const std::filesystem::path& run) {
    return measure::read_json(run / "manifest.json");
}

void write(const std::filesystem::path& run, const nlohmann::json& manifest,
           std::span<const measure::Row> rows, std::span<const ResultSummary> results) {
    const std::vector<SceneResults> scenes = by_scene(results);
    std::vector<Tradeoff> tradeoffs;  // of all scenes
    std::string html;
    try {
        const auto& config = manifest.at("config");
        const std::string name = config.at("name");
        html = document_head(name + " – Grove");
        const bool stability = config.at("kind") == "stability";
        const std::string repetitions =
            fmt::format("{} repetitions, {} warm-up · ", config.at("repeat").dump(),
                        config.at("warmup").dump());
        html += fmt::format("<h1>{}</h1>\n<p class=\"soft\">{} experiment on {} · {}{}</p>\n",
                            escape(name), escape(config.at("kind").get<std::string>()),
                            escape(text_of(manifest.at("device"), "name")),
                            stability ? "" : repetitions,
                            escape(text_of(manifest.at("sessions").front(), "start")));
        if (!stability)
            html +=
                "<p class=\"soft\">Medians; below them, and as thin lines in the charts, minimum "
                "and maximum; thick lines: confidence interval of the median. Green: best of its "
                "column.</p>\n";
        html += failures(manifest);
        if (stability)
            html += stability_section(results);
        else
            for (const SceneResults& scene : scenes) {
                const std::vector<Tradeoff> own = find_tradeoffs(scene.methods);
                html += scene_section(run, manifest, scene, rows, own);
                tradeoffs.insert(tradeoffs.end(), own.begin(), own.end());
            }
        html += provenance(manifest) + "</body>\n</html>\n";
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error((run / "manifest.json").string() +
                                 ": is no manifest of a run: " + error.what());
    }
    measure::write_text(run / "report.html", html);
    if (!tradeoffs.empty()) measure::write_text(run / "pareto.csv", pareto_csv(tradeoffs));
}

}  // namespace

void write_report(const std::filesystem::path& run) {
    // The manifest first: without it the folder is none of a run.
    const nlohmann::json manifest = read_manifest(run);
    const std::vector<measure::Row> rows = measure::read_samples(run / "samples.csv");
    write(run, manifest, rows, measure::summarise(rows));
}

void write_report(const std::filesystem::path& run, std::span<const measure::Row> rows,
                  std::span<const ResultSummary> results) {
    write(run, read_manifest(run), rows, results);
}

}  // namespace experiments::report
