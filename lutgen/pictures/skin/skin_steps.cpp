// SPDX-License-Identifier: Apache-2.0
#include "skin/skin_steps.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "apply/any_picture.h"
#include "apply/frames.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using skin::SkinPixel;
using skin::SkinQuantity;
using spectral::InputError;
using Pixels = std::span<SkinPixel>;

constexpr std::int64_t kMostPixels = std::int64_t{1} << 31;

struct Named {
  const char* flag;
  bool hasQuantity;
  const char* amount;
  const char* help;
};

constexpr std::array<Named, 10> kFlags = {
    {{"--multiply", true, "FACTOR",
      "Multiply a quantity: blood=1.5 (melanin, blood, thickness, melanin_type, "
      "deoxygenation), or by a picture: blood=factors.exr"},
     {"--set", true, "VALUE", "Set a quantity: thickness=120, melanin=map.exr"},
     {"--smooth", true, "RADIUS", "Smooth a quantity by a Gaussian of this deviation in pixels: melanin=4"},
     {"--tan", false, "STRENGTH", "Tan, 0 to 4: more melanin, more of it eumelanin, a thicker epidermis"},
     {"--flush", false, "STRENGTH", "Flush, -0.9 (pale) to 4: more blood with more oxygen"},
     {"--oxygenate", false, "STRENGTH", "Oxygen into the blood (to 1) or out of it (to -1)"},
     {"--thicken", false, "FACTOR", "Multiply the epidermis's thickness"},
     {"--thin", false, "FACTOR", "Divide the epidermis's thickness, as with age"},
     {"--vitiligo", false, "STRENGTH", "Take melanin away, 0 to 1"},
     {"--matte", false, "FILE",
      "Where the edits behind it take place: FILE or FILE:CHANNEL, 0 to 1; none: everywhere"}}};

SkinQuantity quantityNamed(const std::string& name, const std::string& text) {
  // As the channels are called.
  static const std::map<std::string, std::string> others = {{"melanin_type", "eumelanin"},
                                                            {"deoxygenation", "deoxyhaemoglobin"}};
  const auto other = others.find(name);
  try {
    return skin::skinQuantityFromName(other == others.end() ? name : other->second);
  } catch (const InputError&) {
    throw InputError(text, "quantity", name, "write melanin, blood, thickness, melanin_type or deoxygenation");
  }
}

SkinStep::Edit editOf(const std::string& flag, SkinQuantity quantity) {
  using skin::Matte;
  if (flag == "--multiply") {
    return [quantity](Pixels p, double amount, int, Matte m) { multiplySkin(p, quantity, amount, m); };
  }
  if (flag == "--set") {
    return [quantity](Pixels p, double amount, int, Matte m) { setSkin(p, quantity, amount, m); };
  }
  if (flag == "--smooth") {
    return [quantity](Pixels p, double amount, int width, Matte m) { smoothSkin(p, quantity, width, amount, m); };
  }
  if (flag == "--thin") {
    return [](Pixels p, double amount, int, Matte m) { skin::thickenSkin(p, 1 / amount, m); };
  }
  using Simple = void (*)(Pixels, double, Matte);
  static const std::map<std::string, Simple> simple = {{"--tan", &skin::tanSkin},
                                                       {"--flush", &skin::flushSkin},
                                                       {"--oxygenate", &skin::oxygenateSkin},
                                                       {"--thicken", &skin::thickenSkin},
                                                       {"--vitiligo", &skin::bleachSkin}};
  const Simple edit = simple.at(flag);
  return [edit](Pixels p, double amount, int, Matte m) { edit(p, amount, m); };
}

SkinStep stepOf(const Named& named, const std::string& text) {
  SkinStep step;
  step.text = std::string(named.flag) + " " + text;
  std::string amount = text;
  auto quantity = SkinQuantity::Melanin;
  if (named.hasQuantity) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw InputError(named.flag, "edit", text, std::string("write QUANTITY=") + named.amount + ", such as blood=1.5");
    }
    quantity = quantityNamed(text.substr(0, equals), step.text);
    amount = text.substr(equals + 1);
  }
  step.edit = editOf(named.flag, quantity);
  if (const auto number = spectral::parseNumber(amount)) {
    step.amount = *number;
    SkinPixel trial{{0.03F, 0.02F, 90, 0.2F, 0.4F}, 1, {}};
    try {
      step.edit({&trial, 1}, step.amount, 1, {});
    } catch (const InputError& error) {
      throw InputError(step.text, "", "", error.what());
    }
  } else if (amount.empty() || spectral::isNotFinite(amount)) {
    throw InputError(named.flag, "amount", amount, "write a number, or name a picture of them");
  } else if (step.text.rfind("--smooth", 0) == 0) {
    throw InputError(named.flag, "radius", amount, "must be a number of pixels");
  } else {
    step.amountFile = amount;
  }
  return step;
}

/// FILE or FILE:CHANNEL; a file may bear a colon in its name.
std::pair<std::string, std::string> fileAndChannel(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  std::error_code none;
  if (colon == std::string::npos || colon == 0 || std::filesystem::exists(spectral::pathOf(name), none)) {
    return {name, ""};
  }
  return {name.substr(0, colon), name.substr(colon + 1)};
}

int channelOf(const OIIO::ImageSpec& spec, const std::string& file, const std::string& channel) {
  const std::vector<std::string> wanted =
      channel.empty() ? std::vector<std::string>{"Y", "R", "A"} : std::vector<std::string>{channel};
  for (const std::string& name : wanted) {
    if (const int found = spec.channelindex(name); found >= 0) {
      return found;
    }
  }
  if (channel.empty() && spec.nchannels == 1) {
    return 0;
  }
  throw InputError(
      file, "channel", channel,
      "name one of them as FILE:CHANNEL: " + spectral::shortened(spectral::joined(spec.channelnames), 120));
}

}  // namespace

void addSkinSteps(CLI::App& command, SkinStepOptions& options) {
  for (const Named& named : kFlags) {
    options.options.push_back(std::make_unique<SkinStepOptions::Option>());
    SkinStepOptions::Option& own = *options.options.back();
    own.option = command.add_option(named.flag, own.texts, named.help)
                     ->expected(1)
                     ->take_all()
                     ->type_name(named.hasQuantity ? std::string("QUANTITY=") + named.amount : named.amount)
                     ->group("Edits, done in the order in which they stand");
  }
}

std::vector<SkinStep> skinSteps(const CLI::App& command, const SkinStepOptions& options) {
  std::vector<SkinStep> steps;
  std::vector<std::size_t> next(kFlags.size(), 0);
  std::string matte;
  for (const CLI::Option* option : command.parse_order()) {
    const auto found = std::find_if(options.options.begin(), options.options.end(),
                                    [option](const auto& own) { return own->option == option; });
    if (found == options.options.end()) {
      continue;
    }
    const auto k = static_cast<std::size_t>(found - options.options.begin());
    const std::string& text = (*found)->texts.at(next[k]++);
    if (std::string(kFlags[k].flag) == "--matte") {
      matte = text == "none" ? "" : text;
      continue;
    }
    steps.push_back(stepOf(kFlags[k], text));
    steps.back().matteFile = matte;
  }
  if (!matte.empty() && (steps.empty() || steps.back().matteFile != matte)) {
    throw InputError("--matte", "file", matte, "has no edit behind it; a matte stands before the edits that it is for");
  }
  return steps;
}

std::vector<float> skinPlane(const std::string& name, int width, int height, int frame) {
  const auto [text, channel] = fileAndChannel(name);
  const auto pattern = FramePattern::in(text);
  std::error_code none;
  const std::string file =
      pattern && !std::filesystem::exists(spectral::pathOf(text), none) ? pattern->file(frame) : text;
  if (!std::filesystem::exists(spectral::pathOf(file), none)) {
    throw InputError(file, "", "", "is not there; check the path");
  }
  AnyPicture picture(spectral::pathOf(file), kMostPixels);
  const OIIO::ImageSpec& spec = picture.spec(0);
  if (spec.width != width || spec.height * spec.depth != height || spec.deep) {
    throw InputError(file, "size", std::to_string(spec.width) + " x " + std::to_string(spec.height),
                     "must be that of the maps, " + std::to_string(width) + " x " + std::to_string(height));
  }
  const int index = channelOf(spec, file, channel);
  picture.load();
  return picture.values(0, {index});
}

void runSkinStep(const SkinStep& step, std::span<SkinPixel> pixels, int width, int height, int frame) {
  std::vector<float> matte;
  if (!step.matteFile.empty()) {
    matte = skinPlane(step.matteFile, width, height, frame);
  }
  if (step.amountFile.empty()) {
    step.edit(pixels, step.amount, width, matte);
    return;
  }
  const std::vector<float> amounts = skinPlane(step.amountFile, width, height, frame);
  try {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const skin::Matte share = matte.empty() ? skin::Matte() : skin::Matte(&matte[i], 1);
      step.edit(pixels.subspan(i, 1), static_cast<double>(amounts[i]), 1, share);
    }
  } catch (const InputError& error) {
    throw InputError(step.amountFile, "", "", error.what());
  }
}

}  // namespace metamer::lutgen
