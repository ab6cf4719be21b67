#include "apps/command_line/commands.h"
#include "images/image_io.h"
#include "renderer/color/display.h"

namespace parian {

Command add_display_command(CLI::App& app) {
  struct Options {
    std::string input, output, view;
    float exposure = 0;
  };
  CLI::App& c = *app.add_subcommand("display", "Turn a linear EXR into a picture for the screen");
  const auto o = std::make_shared<Options>();
  c.add_option("INPUT", o->input, "Linear Rec.709 picture")->required();
  c.add_option("OUTPUT", o->output, "PNG or JPEG to write")->required();
  c.add_option("--view", o->view, "OpenColorIO view; the config's first by default")->type_name("NAME");
  c.add_option("--exposure", o->exposure, "Stops added before the view [0]")
      ->check(number_between(-100, 100));
  return [o] {
    write_display_image(apply_display(read_picture(o->input), o->view, o->exposure), o->output);
    return kDone;
  };
}

}  // namespace parian
