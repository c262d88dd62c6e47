// SPDX-License-Identifier: Apache-2.0
// chromeball compare SCENE --strategies a,b,c --samples 1,4,16 -o DIR
#include <algorithm>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "base/json.h"
#include "commands.h"
#include "display_options.h"
#include "front/plan_render.h"
#include "image/io/output_file.h"
#include "image/tonemap.h"
#include "interrupt.h"
#include "lighting/methods.h"
#include "messages.h"
#include "progress_bar.h"
#include "scene_options.h"
#include "session/image_header.h"
#include "session/render_loaded.h"
#include "session/render_report.h"
#include "study/report/report.h"
#include "study/result_tables.h"
#include "study/study.h"
#include "study/study_run.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

struct CompareArguments {
  SceneOptions scene;
  std::vector<std::string> strategies{"all"}, integrators;
  std::vector<int> samples;
  std::vector<double> times;
  int repeats = 4;
  std::string reference, referenceStrategy = "auto", baseline, folder;
  std::optional<int> referenceSamples;
};

// Combines each strategy, or all, with each integrator, except rows that name one.
std::vector<std::string> resolveRows(const std::vector<std::string>& strategies,
                                     const std::vector<std::string>& integrators) {
  std::vector<std::string> given, names;
  for (const std::string& name : strategies)
    if (name != "all")
      given.push_back(rowNamed(name, "--strategies").name());
    else
      for (const std::string_view known : strategyNames())
        given.push_back(resolveStrategy(std::string(known)));
  const auto add = [&](const Row& row) {
    if (std::ranges::count(names, row.name()) == 0) names.push_back(row.name());
  };
  for (const std::string& strategy : given) {
    const Row row = rowNamed(strategy, "--strategies");
    if (integrators.empty() || row.integrator != IntegratorKind::Path)
      add(row);
    else
      for (const std::string& integrator : integrators)
        add(rowNamed(strategy + "+" + integrator, "--integrators"));
  }
  return names;
}

// The first of the rows with the same pixels as this one; its own name if there is none.
std::string standIn(const std::string& name, const std::vector<std::string>& rows) {
  const auto represented = [](const std::string& row) {
    return rowNamed(row, "--strategies").representative().name();
  };
  const auto found = std::ranges::find(rows, represented(name), represented);
  return found == rows.end() ? name : *found;
}

// Keeps the first of rows with the same pixels; of the others, a note.
Messages mergeEqualRows(std::vector<std::string>& rows) {
  std::vector<std::string> kept;
  std::map<std::string, std::vector<std::string>> dropped;  // by the row that stays
  for (const std::string& name : rows) {
    const std::string first = standIn(name, kept);
    first == name ? kept.push_back(name) : dropped[first].push_back(name);
  }
  rows = kept;
  Messages notes;
  for (const auto& [first, others] : dropped)
    addNote(notes, "{} {} the same image as {}, which is compared alone", fmt::join(others, ", "),
            others.size() == 1 ? "is" : "are", first);
  return notes;
}

void sortUnique(std::vector<Budget>& budgets) {
  std::sort(budgets.begin(), budgets.end());
  budgets.erase(std::unique(budgets.begin(), budgets.end()), budgets.end());
}

std::vector<Budget> planBudgets(const CompareArguments& a) {
  std::vector<Budget> budgets;
  for (const int samples : a.samples) {
    if (samples < 1) throwInput("--samples: {} is not 1 or more", samples);
    budgets.push_back({false, double(samples)});
  }
  for (const double seconds : a.times) {
    if (!(seconds > 0) || !std::isfinite(seconds))
      throwInput("--times: {} is not above 0 seconds", seconds);
    budgets.push_back({true, seconds});
  }
  if (budgets.empty()) budgets = {{false, 1}, {false, 4}, {false, 16}, {false, 64}};
  sortUnique(budgets);
  return budgets;
}

// 16 times the largest budget, so that the reference's variance is small compared with each
// strategy's unless the reference's own strategy is less than half as efficient. The number of
// samples in a budget of seconds is unknown.
int planReferenceSamples(const CompareArguments& a, const std::vector<Budget>& budgets) {
  constexpr int kFactor = 16, kMin = 1024;
  if (a.referenceSamples && *a.referenceSamples < Study::kReferenceParts)
    throwInput("--reference-samples: {} is not {} or more", *a.referenceSamples,
               Study::kReferenceParts);
  double maximum = 0;
  for (const Budget& budget : budgets)
    maximum = std::max(maximum, budget.timed ? kMin : budget.amount);
  return a.referenceSamples.value_or(std::max(kMin, int(std::min(kFactor * maximum, 1e6))));
}

Study planStudy(const CompareArguments& a, const Command& command, Messages& notes) {
  Study study;
  study.folder = a.folder;
  study.strategies = resolveRows(a.strategies, a.integrators);
  notes = mergeEqualRows(study.strategies);
  study.budgets = planBudgets(a);
  if (a.repeats < Study::kMinRepeats)
    throwInput("--repeats: {} is not {} or more", a.repeats, Study::kMinRepeats);
  study.repeats = a.repeats;
  if (!a.baseline.empty()) {
    study.baseline = standIn(rowNamed(a.baseline, "--baseline").name(), study.strategies);
    if (std::ranges::count(study.strategies, study.baseline) == 0)
      throwInput("--baseline: `{}` is not among the compared strategies", a.baseline);
  }
  study.referenceFile = a.reference;
  if (!a.reference.empty())
    command.refuse({"--reference-samples", "--reference-strategy"},
                   "the reference is a file; give one or the other");
  study.referenceStrategy = rowNamed(a.referenceStrategy, "--reference-strategy").name();
  planReferenceSamples(a, study.budgets);  // throws for an invalid number
  if (a.folder.empty()) throwInput("--output: the name of the folder is empty");
  if (fs::exists(a.folder) && !fs::is_directory(a.folder))
    throwInput("--output: {} is a file; give a folder", a.folder);
  return study;
}

// The results include the renders of earlier runs in the folder.
void showStored(Study& study, const RenderStore& store) {
  study.shownStrategies = study.strategies;
  study.shownBudgets = study.budgets;
  for (const RenderKey& key : store.firstRepeats()) {
    auto& names = study.shownStrategies;
    if (std::count(names.begin(), names.end(), key.strategy) == 0) names.push_back(key.strategy);
    study.shownBudgets.push_back(key.budget);
  }
  sortUnique(study.shownBudgets);
}

void checkReference(const StudyRun& run, const Study& study) {
  if (study.referenceFile.empty() && !run.unbiased(kReference))
    throwInput("--reference-strategy: `{}` is biased; a reference must be unbiased",
               study.referenceStrategy);
}

void compare(const CompareArguments& a, const Command& command) {
  SceneFile scene = openScene(a.scene.scene);
  const bool hadComposite = scene.composite.has_value();
  scene.composite.reset();
  if (hadComposite && scene.plateScale && !a.scene.settings.has("probe.scale"))
    throw InputError(fmt::format("{}: scale = \"plate\" is of the [composite], which is ignored "
                                 "here; give the number that a render of the scene prints",
                                 *scene.plateScale),
                     Remedy{"probe.scale", {}});
  dropUnheeded(scene, SceneCommand::Compare);
  RenderDescription description = planRender(std::move(scene), a.scene.settings);
  Messages ofRows;
  Study study = planStudy(a, command, ofRows);
  // What is said of the suns' angle holds for the rows that have suns.
  const auto hasSuns = [](const std::string& row) { return row.starts_with("suns"); };
  if (description.origins.has("lighting.sun_angle") &&
      std::ranges::any_of(study.strategies, hasSuns))
    description.lighting.strategy = "suns";
  const ThreadLimit threads = threadLimit(a.scene.settings);
  const LoadedScene loaded = loadScene(description);
  description = loaded.description;
  // The renders in the folder are not among the outputs, because they are read, not overwritten.
  const auto file = [&](const char* name) { return (fs::path(a.folder) / name).string(); };
  const std::string csv = file("results.csv"), json = file("results.json"),
                    samples = file("samples.svg"), seconds = file("seconds.svg"),
                    page = file("index.html");
  std::vector<std::string> inputs = loaded.files;
  inputs.insert(inputs.end(), {a.scene.scene, a.reference});
  checkDistinct({csv, json, samples, seconds, page}, inputs);
  description.settings.noiseLimit.reset();
  study.seed = description.settings.seed;
  study.identity = identityOf(loaded);

  const RenderStore store(study, {description.settings.width, description.settings.height});
  showStored(study, store);
  study.referenceSamples = planReferenceSamples(a, study.shownBudgets);
  StudyRun run(study, store, loaded, description.settings);
  checkReference(run, study);
  Messages ofReference;
  if (!study.referenceFile.empty())
    loadReference(study, store, description.settings.width, description.settings.height,
                  &ofReference);
  print(ofRows);
  print(ofReference);
  print(loaded.messages);
  print(run.idleModes());
  if (hadComposite)
    warn(
        "{}: [composite] is ignored: strategies are compared on the whole model, without the plate",
        a.scene.scene);

  ReportScene about{fs::path(a.scene.scene).filename().string(),
                    &loaded.probe,
                    description.output.display.exposure,
                    {}};
  const auto results = [&] {
    const RenderSettings& s = description.settings;
    const Reference reference = loadReference(study, store, s.width, s.height);
    if (description.output.choosesExposure) about.exposure = autoExposure(reference.mean);
    return studyResults(study, store, reference);
  };
  for (const std::string& name : study.strategies)
    about.directions.emplace_back(name, sampledDirections(run.strategy(name)));
  const auto write = [&](const StudyResults& r) {
    const Machine machine = thisMachine();
    writeText(csv, resultsCsv(r));
    writeText(json, jsonText(resultsJson(study, r, machine), 2) + "\n");
    writeText(samples, samplesPlot(r));
    writeText(seconds, secondsPlot(r));
    writeText(page, reportHtml(study, store, r, about, machine));
  };
  catchInterrupts();
  const bool whole = [&] {
    ProgressBar bar(progressStyle());
    return run.run([&](double fraction) { bar.update(fraction); }, [&] { write(results()); },
                   interrupted);
  }();
  if (!whole)
    throw Interrupted(fmt::format(
        "interrupted; {} of {} renders are in {}, and the same command continues from there",
        run.stored(), run.total(), study.folder));
  const StudyResults all = results();
  write(all);
  for (const std::string& warning : all.warnings) warn(warning);
  if (verbosity().quiet) return;
  fmt::print("{}", resultsTable(study, all));
  for (const std::string& sentence : verdict(study, all)) fmt::print("{}\n", sentence);
  fmt::print("Report: {}{}\n", (fs::path(study.folder) / "index.html").string(),
             description.output.choosesExposure
                 ? ", " + exposureInWords(about.exposure, "auto, of the reference")
                 : "");
}

}  // namespace

void addCompareCommand(Command app) {
  auto [command, a] = app.addCommand<CompareArguments>(
      "compare", "Compare lighting strategies on a scene: error, bias and time", compare);
  addSceneOptions(command, a.scene, SceneCommand::Compare);
  command.footer(strategyHelp());
  command
      .addOption("--strategies", a.strategies,
                 "NAME or NAME:COUNT, separated by commas; all if not given. With +adaptive, "
                 "+guide, +regularize, +glass-shadows or +denoise: NAME+regularize+denoise; "
                 "+environment-map with +ao, +reflection-occlusion; +diffuse-depth:N, "
                 "+specular-depth:N, +irradiance-cache:ERROR")
      .delimiter(',');
  command
      .addOption("--integrators", a.integrators,
                 "Renders each strategy with each of these, separated by commas: path, direct, "
                 "ambient-occlusion, environment-map (as modes: NAME+ambient-occlusion)")
      .delimiter(',');
  command
      .addOption("--samples", a.samples,
                 "Samples per pixel; 1,4,16,64 if neither these nor --times are given")
      .delimiter(',');
  command.addOption("--times", a.times, "Seconds per render: 1,2,4").delimiter(',');
  command.addWithDefault("--repeats", a.repeats,
                         "Independent renders of each strategy and budget, 3 or more");
  command.addOption("--reference", a.reference, "Reference image; else it is rendered");
  command.addOption("--reference-samples", a.referenceSamples,
                    "Samples per pixel of a reference that is rendered");
  command.addWithDefault("--reference-strategy", a.referenceStrategy,
                         "Strategy of a reference that is rendered");
  command.addOption("--baseline", a.baseline,
                    "Strategy whose efficiency is 1; else the best unbiased one");
  command.addRequired("-o,--output", a.folder,
                      "Folder of the report; a comparison in it is continued");
}

}  // namespace chromeball
