// SPDX-License-Identifier: Apache-2.0
#include "stage/match_answer.h"

#include "metamer/spectral/formatted.h"
#include "metamer/stage/chart_difference.h"
#include "stage/eotf_words.h"
#include "stage/match_report.h"

namespace metamer::lutgen {
namespace {

using spectral::formatted;

std::string nameOf(const MatchAnswer& answer) {
  return answer.filter.empty() ? answer.outcome.target : answer.outcome.target + " + " + answer.filter;
}

std::string stepOf(const stage::DriveSteps& steps, Eigen::Index emitter) {
  return steps.unit == "percent" ? formatted("%.2f %%", steps.values[emitter])
                                 : formatted("%.0f", steps.values[emitter]);
}

std::string limitsInWords(const MatchAnswer& answer) {
  const stage::LimitCost& cost = *answer.limitCost;
  std::string held;
  for (const int emitter : cost.held) {
    held += (held.empty() ? "" : ", ") + answer.outcome.emitters[static_cast<std::size_t>(emitter)] +
            formatted(" (asks %.4g)", cost.asked[emitter]);
  }
  if (cost.budgetIsSpent) {
    held += held.empty() ? "the power budget" : " and the power budget";
  }
  return formatted(
      "limits hold %s: mean CIEDE2000 %.2f in place of %.2f; at a level of %.3g (--level free) they cost no "
      "colour",
      held.c_str(), cost.meanWithin, cost.meanWithout, cost.level);
}

/// What a match says beside its drives and differences, a line each.
std::vector<std::string> linesOf(const MatchAnswer& answer) {
  std::vector<std::string> lines;
  if (answer.level) {
    lines.push_back(formatted("level free: the light is %.4g of the target", *answer.level));
  }
  if (answer.limitCost) {
    lines.push_back(limitsInWords(answer));
  }
  if (answer.steps) {
    std::string text = answer.steps->unit + ":";
    for (Eigen::Index k = 0; k < answer.steps->values.size(); ++k) {
      text += (k == 0 ? " " : ", ") + stepOf(*answer.steps, k);
    }
    lines.push_back(text + formatted("; rounded so, CIEDE2000 mean %.2f max %.2f", answer.steps->meanDifference,
                                     answer.steps->maxDifference));
    for (std::size_t k = 0; k < answer.eotfs.size(); ++k) {
      lines.push_back("EOTF of " + answer.outcome.emitters[k] + ": " + textOf(answer.eotfs[k]));
    }
  }
  if (answer.intervals) {
    const stage::MatchIntervals& intervals = *answer.intervals;
    std::string text = formatted(
        "95 %% intervals of %d draws of noise (%.2g %%, %s): CIEDE2000 mean %.2f to %.2f; drives", intervals.samples,
        100 * intervals.noise.relative, intervals.noiseIs.c_str(), intervals.mean.low, intervals.mean.high);
    for (Eigen::Index k = 0; k < intervals.drives.low.size(); ++k) {
      text += formatted("%s %.4g to %.4g", k == 0 ? "" : ",", intervals.drives.low[k], intervals.drives.high[k]);
    }
    lines.push_back(text);
  }
  return lines;
}

}  // namespace

Json toJson(const MatchAnswer& answer) {
  Json json = toJson(answer.outcome);
  if (!answer.filter.empty()) {
    json["filter"] = answer.filter;
  }
  if (answer.level) {
    json["level"] = numberToJson(*answer.level);
  }
  if (answer.limitCost) {
    const stage::LimitCost& cost = *answer.limitCost;
    Json held = Json::array();
    for (const int emitter : cost.held) {
      held.push_back(answer.outcome.emitters[static_cast<std::size_t>(emitter)]);
    }
    json["limits_cost"] = {{"held", held},
                           {"budget_is_spent", cost.budgetIsSpent},
                           {"drives_without", toJson(cost.asked)},
                           {"dE_mean_without", numberToJson(cost.meanWithout)},
                           {"dE_mean_within", numberToJson(cost.meanWithin)},
                           {"level_without_cost", numberToJson(cost.level)}};
  }
  if (answer.steps) {
    json["steps"] = {
        {"unit", answer.steps->unit},
        {"values", toJson(answer.steps->values)},
        {"dE",
         {{"mean", numberToJson(answer.steps->meanDifference)}, {"max", numberToJson(answer.steps->maxDifference)}}}};
    for (const stage::PanelEotf& eotf : answer.eotfs) {
      json["steps"]["eotf"].push_back(toJson(eotf));
    }
  }
  if (answer.intervals) {
    const stage::MatchIntervals& intervals = *answer.intervals;
    json["intervals"] = {{"confidence", 0.95},
                         {"noise", {{"relative", intervals.noise.relative}, {"floor", intervals.noise.floor}}},
                         {"noise_is", intervals.noiseIs},
                         {"samples", intervals.samples},
                         {"drives", {{"low", toJson(intervals.drives.low)}, {"high", toJson(intervals.drives.high)}}},
                         {"dE_mean", Json::array({intervals.mean.low, intervals.mean.high})}};
  }
  return json;
}

std::string summaryOf(const MatchAnswer& answer) {
  std::string text = summaryOf(answer.outcome);
  for (const std::string& line : linesOf(answer)) {
    text += line + "\n";
  }
  return text;
}

std::string reportOf(const MatchAnswer& answer, const std::string& figure) {
  std::string text = reportOf(answer.outcome, figure);
  const std::vector<std::string> lines = linesOf(answer);
  for (const std::string& line : lines) {
    text += (&line == &lines.front() ? "\n- " : "- ") + line + "\n";
  }
  return text;
}

Json toJson(const std::vector<MatchAnswer>& answers) {
  Json list = Json::array();
  for (const MatchAnswer& answer : answers) {
    list.push_back(toJson(answer));
  }
  return {{"matches", list}};
}

std::string summaryOf(const std::vector<MatchAnswer>& answers) {
  std::string text;
  for (const MatchAnswer& answer : answers) {
    const stage::DifferenceSummary summary = stage::summaryOf(differencesOf(answer.outcome));
    text += formatted("%-30s CIEDE2000 mean %5.2f max %6.2f ", nameOf(answer).c_str(), summary.mean, summary.max);
    if (answer.level) {
      text += formatted(" level %.4g ", *answer.level);
    }
    for (Eigen::Index k = 0; k < answer.outcome.match.drives.size(); ++k) {
      text += k == 0 ? " " : ", ";
      text += answer.steps ? stepOf(*answer.steps, k) : formatted("%.4g", answer.outcome.match.drives[k]);
    }
    text += answer.limitCost ? "  (held by limits)\n" : "\n";
  }
  return text;
}

std::string reportOf(const std::vector<MatchAnswer>& answers) {
  std::string text = "# " + std::to_string(answers.size()) + " lights by " +
                     std::to_string(answers.front().outcome.emitters.size()) +
                     " emitters\n\n| light | mean | max | level |";
  std::string rule = "\n| --- | --- | --- | --- |";
  for (const std::string& emitter : answers.front().outcome.emitters) {
    text += " " + emitter + " |";
    rule += " --- |";
  }
  text += rule + "\n";
  for (const MatchAnswer& answer : answers) {
    const stage::DifferenceSummary summary = stage::summaryOf(differencesOf(answer.outcome));
    text += formatted("| %s | %.2f | %.2f | %.4g |", nameOf(answer).c_str(), summary.mean, summary.max,
                      answer.level.value_or(1));
    for (Eigen::Index k = 0; k < answer.outcome.match.drives.size(); ++k) {
      text +=
          " " + (answer.steps ? stepOf(*answer.steps, k) : formatted("%.4g", answer.outcome.match.drives[k])) + " |";
    }
    text += "\n";
  }
  for (const MatchAnswer& answer : answers) {
    if (answer.limitCost) {
      text += "\n" + nameOf(answer) + ": " + limitsInWords(answer) + "\n";
    }
  }
  return text;
}

}  // namespace metamer::lutgen
