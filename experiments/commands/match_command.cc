
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/front_end_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/data/match_file.h"
#include "experiments/real/images/match_images.h"

namespace rcme {

void AddMatchCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("match", "Match two undistorted images and write a file for `rcme estimate`");
  command->footer(R"(Every match has a column sigma_px: its noise relative to the other matches, from the
sizes of its key points. A K that does not fit the size of its image gives a warning; an
impossible K is refused.

Examples:
  rcme match left.png right.png --K1 718.9 718.9 607.2 185.2 --out pair.csv.gz
  rcme estimate pair.csv.gz)");
  auto arguments = std::make_shared<MatchImagesOptions>();
  auto out = std::make_shared<std::string>();
  command
      ->add_option("image1", arguments->image1,
                   "first image: PNG, JPEG, TIFF, BMP or PNM; above 4096 x 4096 px it is scaled down to find "
                   "key points, "
                   "which are written in its original pixels")
      ->required();
  command->add_option("image2", arguments->image2, "second image")->required();
  command->add_option("--K1", arguments->K1, "fx fy cx cy of the first camera, in px of the original image")
      ->transform(NumberIn())
      ->expected(4)
      ->required();
  command->add_option("--K2", arguments->K2, "fx fy cx cy of the second camera; default: --K1")
      ->transform(NumberIn())
      ->expected(4);
  AddFrontEndOptions(command, &arguments->detector, &arguments->matcher, &arguments->has_scores);
  command->add_option("-o,--out", *out, "match file to write")->required();
  auto format = std::make_shared<std::string>("table");
  AddFormatOption(command, format.get());
  command->callback([arguments, out, format] {
    CheckIsNoInput(*out, {arguments->image1, arguments->image2});
    const MatchFile file = MatchImages(*arguments);
    InputWarnings warnings;
    warnings.Add(file.doubts);
    warnings.Print();
    WriteMatchFile(file, *out);
    if (file.matches.empty()) {
      PrintMessage("no match was kept -> {}\n", *out);
    } else {
      PrintMessage("{} matches -> {}; next: rcme estimate {}\n", file.matches.size(), *out,
                   QuoteForShell(*out));
    }
    Table table{
        {Column::Text("image1"), Column::Text("image2"), Column::Count("matches"), Column::Text("file")}};
    table.rows.push_back({arguments->image1, arguments->image2, std::ssize(file.matches), *out});
    PrintResult(MakeResult("", kMatchFormat, {}, table), *format);
  });
}

}  // namespace rcme
