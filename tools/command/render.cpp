// SPDX-License-Identifier: Apache-2.0
// chromeball render: renders a scene to image files.
#include "base/error.h"
#include "commands.h"
#include "front/plan_render.h"
#include "front/sequence.h"
#include "image/io/output_file.h"
#include "image_render.h"
#include "interrupt.h"
#include "lighting/methods.h"
#include "messages.h"
#include "scene_notes.h"
#include "scene_options.h"
#include "session/develop_image.h"
#include "session/render_messages.h"
#include "viewers/viewers.h"

namespace chromeball {
namespace {

void renderStill(const SceneFile& scene, const SceneOptions& options,
                 const Messages& sequenceMessages) {
  RenderDescription description = planRender(scene, options.settings);
  const Messages outputMessages = checkOutputs(description);
  const ThreadLimit threads = threadLimit(options.settings);
  const Viewers viewers(options.settings, [] { interrupted = true; });

  Stopwatch watch;
  PhaseSeconds seconds;
  LoadedScene loaded = loadScene(description);
  seconds.load = watch.lap();
  const PreparedScene prepared = prepareScene(loaded);
  seconds.build = prepared.buildSeconds;
  seconds.prepare = prepared.prepareSeconds;
  prepareOutputs(loaded.description, loaded.files);
  catchInterrupts(description.settings.denoisesAtEnd()
                      ? "interrupted: denoising what there is; Ctrl-C again leaves without"
                      : "");
  watch.lap();
  std::optional<float> exposure;
  if (needsExposure(loaded.description)) {
    exposure = meteredExposure(loaded, prepared, interrupted);
    loaded.description.output.expose(*exposure);
  }
  seconds.prepare += watch.lap();
  description = loaded.description;
  std::optional<RenderPart> part = identified(loaded);
  FinishedRender result = [&] {
    ImageRender render(loaded, viewers.all());
    print(viewers.messages());  // after the last error that input can cause
    print(sequenceMessages);
    print(outputMessages);
    print(loaded.messages);
    print(sceneNotes(loaded));
    return render.run(prepared, [](double fraction) { return fraction; }, {interrupted, leaving});
  }();
  addState(loaded, part, result);
  if (result.render.samples == 0)  // must not overwrite an image that may be complete
    for (std::string& file : description.output.files) file = partialName(file);
  writeImages(description, loaded, result, seconds);

  print(resultMessages(loaded, prepared, result, optionInWords));
  printOutcome(description, result, exposure);
}

void render(const SceneOptions& options) {
  const SceneFile scene = openScene(options.scene);
  const Sequence sequence(scene, options.settings);
  sequence.numbers().empty() ? renderStill(scene, options, sequence.messages())
                             : renderFrames(sequence, options);
}

}  // namespace

void addRenderCommand(Command app) {
  auto [command, a] =
      app.addCommand<SceneOptions>("render", "Render a scene file or a model to an image", render);
  addSceneOptions(
      command, a, SceneCommand::Render,
      "  chromeball render helmet.glb --probe studio.hdr --quality draft -o helmet.png\n"
      "  chromeball render scene.toml --time 60 --denoise -o scene.exr -o scene.png\n");
  command.footer(strategyHelp());
}

}  // namespace chromeball
