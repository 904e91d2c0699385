// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <filesystem>
#include <kainjow/mustache.hpp>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "report/findings.h"
#include "report/page_parts.h"
#include "words.h"

namespace metamer::lutgen {
namespace {

using kainjow::mustache::data;
using spectral::formatted;

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - at);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < left ? static_cast<unsigned char>(bytes[at + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= left ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

/// A user's file without its folder: a page is sent round.
std::string withoutFolder(const std::string& name) {
  return name.find('/') == std::string::npos && name.find('\\') == std::string::npos
             ? name
             : spectral::utf8(spectral::pathOf(name).filename());
}

std::string lightText(const sip::RecipePipeline& side) {
  std::string text = withoutFolder(side.illuminant);
  for (const sip::RecipeFilter& filter : side.filters) {
    text += " through " + withoutFolder(filter.name) +
            (filter.density == 1 ? std::string() : formatted(" (density %g)", filter.density));
  }
  return text;
}

std::string adaptationText(double degree) {
  return degree >= 1 ? "The eye is fully adapted to the new light: greys stay grey."
         : degree <= 0
             ? "The eye stays adapted to the old light: the cast of the new one shows in full."
             : formatted("The eye is %.0f %% adapted to the new light: some of its cast shows.", 100 * degree);
}

data listOf(const std::vector<std::string>& texts) {
  data list(data::type::list);
  for (const std::string& text : texts) {
    list.push_back(data(text));
  }
  return list;
}

data chartData(const Chart& chart) {
  data entry;
  entry.set("drawing", chart.drawing);
  entry.set("caption", chart.caption);
  return entry;
}

data chartsData(const std::vector<Chart>& charts) {
  data list(data::type::list);
  for (const Chart& chart : charts) {
    list.push_back(chartData(chart));
  }
  return list;
}

data picturesData(const PageContents& contents) {
  data list(data::type::list);
  for (std::size_t k = 0; k < contents.pictures.size(); ++k) {
    const ShownPicture& picture = contents.pictures[k];
    data entry;
    entry.set("index", std::to_string(k + 1));
    entry.set("title", picture.title);
    entry.set("width", std::to_string(picture.width));
    entry.set("height", std::to_string(picture.height));
    entry.set("before", base64(picture.before));
    entry.set("after", base64(picture.after));
    entry.set("caption", pictureWords(picture, contents.forms, contents.view));
    list.push_back(entry);
  }
  return list;
}

data groupsData(const PageContents& contents) {
  data list(data::type::list);
  for (std::size_t k = 0; k < contents.groups.size(); ++k) {
    const SurfaceGroup& group = contents.groups[k];
    data entry = chartData(contents.surfaces[k]);
    entry.set("title", group.title);
    data rows(data::type::list);
    for (const KnownSurface& surface : group.surfaces) {
      data row;
      row.set("name", surface.name);
      row.set("engine", formatted("%.2f", surface.engineError));
      row.set("plain", formatted("%.2f", surface.plainError));
      row.set("noise", formatted("%.2f", surface.noise));
      row.set("plainNoise", formatted("%.2f", surface.plainNoise));
      rows.push_back(row);
    }
    entry.set("rows", rows);
    list.push_back(entry);
  }
  return list;
}

data setsData(const std::vector<sip::HeldOutSet>& sets) {
  data list(data::type::list);
  for (const sip::HeldOutSet& set : sets) {
    data row;
    row.set("name", set.name);
    row.set("count", std::to_string(set.count));
    row.set("engine", formatted("%.3f", set.engine));
    row.set("plain", formatted("%.3f", set.adaptation));
    row.set("polynomial", formatted("%.3f", set.rootPolynomial));
    list.push_back(row);
  }
  return list;
}

data formsData(const std::vector<BakedForm>& forms) {
  data list(data::type::list);
  for (const BakedForm& form : forms) {
    data entry;
    entry.set("label", form.label);
    entry.set("command", form.command);
    entry.set("sha256", form.certificate.sha256);
    list.push_back(entry);
  }
  return list;
}

/// The certificates, a figure a row, digits as certificates and `lutgen compare` have them.
data figuresData(const std::vector<BakedForm>& forms) {
  data list(data::type::list);
  const auto add = [&](const std::string& label, auto textOf) {
    std::vector<std::string> values;
    for (const BakedForm& form : forms) {
      values.push_back(textOf(form));
    }
    data row;
    row.set("label", label);
    row.set("values", listOf(values));
    list.push_back(row);
  };
  add("kind",
      [](const BakedForm& form) { return representationText(form.certificate.representation, form.certificate.size); });
  add("exposures judged, stops round 18 % grey", [](const BakedForm& form) {
    return formatted("%+d to %+d", form.certificate.probes.lowestStop, form.certificate.probes.highestStop);
  });
  add("mean", [](const BakedForm& form) { return formatted("%.4f", form.certificate.error.mean); });
  add("99 of 100 within (p99)", [](const BakedForm& form) { return formatted("%.4f", form.certificate.error.p99); });
  add("worst, looked for", [](const BakedForm& form) { return formatted("%.4f", form.certificate.error.max); });
  add("worst colour", [](const BakedForm& form) { return form.certificate.error.worstProbe; });
  add("lutgen compare: mean, p99, max", [](const BakedForm& form) {
    return formatted("%.4f, %.4f, %.4f", form.comparison.mean, form.comparison.p99, form.comparison.max);
  });
  add("photographs: of 255 display steps, 99 of 100 pixels within",
      [](const BakedForm& form) { return formatted("%.2f", form.certificate.pixels.photographCodes); });
  return list;
}

data inputsData(const std::vector<ocio::CertifiedInput>& inputs) {
  data list(data::type::list);
  for (const ocio::CertifiedInput& input : inputs) {
    data row;
    row.set("role", input.role);
    row.set("name", withoutFolder(input.provenance.name));
    row.set("sha256", input.provenance.sha256);
    row.set("source", input.provenance.source);
    list.push_back(row);
  }
  return list;
}

std::string partText(const char* name) {
  return std::string(pagePart(name));
}

}  // namespace

std::string htmlOf(const PageContents& contents) {
  const ocio::Certificate& certificate = contents.forms.front().certificate;
  data page;
  page.set("style", partText("page.css"));
  page.set("script", partText("page.js"));
  page.set("name", contents.recipe.name);
  page.set("lightIn", lightText(contents.recipe.input));
  page.set("lightOut", lightText(contents.recipe.output));
  page.set("adaptationText", adaptationText(contents.recipe.adaptation));
  page.set("findings", listOf(findings(contents.forms, contents.groups, contents.pictures)));
  page.set("pictures", picturesData(contents));
  page.set("isLive", data(!contents.live.empty()));
  page.set("live", contents.live);
  page.set("spectra", chartsData(contents.spectra));
  page.set("groups", groupsData(contents));
  page.set("hasSets", data(!certificate.surfaces.empty()));
  page.set("sets", setsData(certificate.surfaces));
  page.set("field", contents.field.drawing);
  page.set("fieldCaption", contents.field.caption);
  page.set("noiseText", noiseWords(contents.groups, certificate));
  page.set("forms", formsData(contents.forms));
  page.set("figures", figuresData(contents.forms));
  page.set("maps", chartsData(contents.maps));
  page.set("inputs", inputsData(certificate.inputs));
  page.set("recipe", sip::toYaml(contents.recipe));
  page.set("madeBy", "Made by metamer " + ocio::toolVersion() + ", lutgen report");
  page.set("credits", contents.hasOwnPhotographs
                          ? "Portrait: Eileen Collins, by NASA, public domain. Coffee: by Rachel Michetti, CC0."
                          : "");
  kainjow::mustache::mustache form(partText("page.html"));
  std::string html = form.render(page);
  if (!form.is_valid() || !form.error_message().empty()) {
    throw spectral::InputError("report", "page.html", "", form.error_message());
  }
  return html;
}

}  // namespace metamer::lutgen
