// SPDX-License-Identifier: Apache-2.0
#include "files/shader_text.h"

#include <openssl/evp.h>

#include <bit>
#include <cstring>
#include <sstream>

#include "metamer/ocio/shader_bake.h"
#include "metamer/spectral/input_error.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

static_assert(std::endian::native == std::endian::little, "tables are written as they lie in memory");

constexpr std::string_view kTables = "/* metamer tables: ";
constexpr std::size_t kLine = 120;

/// How a program uses the text, a line each.
std::string_view exampleOf(sip::DeviceDialect dialect) {
  switch (dialect) {
    case sip::DeviceDialect::OpenCl:
      return R"(program = clCreateProgramWithSource(context, 1, &text, NULL, NULL);
clBuildProgram(program, 1, &device, "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt", NULL, NULL);
kernel = clCreateKernel(program, "metamerMapPixels", NULL);
arguments 0 to 4: source, destination (cl_mem, float4 a pixel), the count of pixels (cl_uint), nodes, cells (cl_mem);
clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &pixelsRoundedUp, NULL, 0, NULL, NULL);
In a kernel of your own: pixel = metamerMap(pixel, nodes, cells);)";
    case sip::DeviceDialect::Cuda:
      return R"(metamerMapPixels<<<(count + 255) / 256, 256>>>(source, destination, count, nodes, cells);
with nodes as const float4*, cells as const unsigned*, in device memory.
In a kernel of your own: pixel = metamerMap(pixel, nodes, cells);)";
    case sip::DeviceDialect::Metal:
      return R"(let options = MTLCompileOptions(); options.fastMathEnabled = false
let library = try device.makeLibrary(source: text, options: options)
let state = try device.makeComputePipelineState(function: library.makeFunction(name: "metamerMapPixels")!)
buffers 0 to 4: source, destination (float4 a pixel), the count of pixels (uint32), nodes, cells;
encoder.dispatchThreads(MTLSize(width: count, height: 1, depth: 1), ...)
In a kernel of your own: pixel = metamerMap(pixel, nodes, cells);)";
    case sip::DeviceDialect::Glsl:
      return R"(Storage buffers 0 to 3: source, destination (vec4 a pixel), nodes, cells; glUniform1ui(0, count);
glDispatchCompute((count + 63) / 64, 1, 1);
In a shader of your own, with METAMER_NO_ENTRY defined: colour = metamerMap(colour);)";
    case sip::DeviceDialect::Hlsl:
      return R"(Compile metamerMapPixels for cs_5_0 with /Gis. t0: source, u0: destination (float4 a pixel), t1: nodes, t2: cells,
b0: the count of pixels; context->Dispatch((count + 63) / 64, 1, 1);
In a shader of your own, with METAMER_NO_ENTRY defined: colour = metamerMap(colour);)";
  }
  return {};
}

/// A comment must not end early, nor go on into the next line.
std::string commentOf(std::string_view line) {
  std::string text = "//";
  text += line.empty() ? "" : " ";
  for (const char letter : line) {
    const bool isPlain = letter >= ' ' && letter <= '~' && letter != '\\';
    text += isPlain ? letter : '?';
  }
  return text + "\n";
}

std::string comments(std::string_view lines) {
  std::string text;
  std::istringstream stream{std::string(lines)};
  for (std::string line; std::getline(stream, line);) {
    text += commentOf(line);
  }
  return text;
}

std::string bytesOf(const sip::DeviceTables& tables) {
  const std::size_t nodeBytes = sizeof(tables.nodes[0]) * tables.nodes.size();
  const std::size_t cellBytes = sizeof(tables.cells[0]) * tables.cells.size();
  std::string bytes(nodeBytes + cellBytes, '\0');
  std::memcpy(bytes.data(), tables.nodes.data(), nodeBytes);
  std::memcpy(bytes.data() + nodeBytes, tables.cells.data(), cellBytes);
  return bytes;
}

std::string headOf(const LutDescription& description) {
  std::string text = commentOf(description.name) + commentOf(description.id);
  for (const std::string& line : description.lines) {
    text += commentOf(line);
  }
  return text + commentOf({});
}

}  // namespace

std::string shaderText(const sip::ChromaticityGrid& grid, const LutDescription& description) {
  return headOf(description) +
         comments(
             "A DCTL of DaVinci Resolve: put it into the LUT folder, and into a node as ResolveFX DCTL. It takes "
             "linear\n"
             "pixels of that space: a Color Space Transform before it makes them (its output gamma Linear), one after "
             "it\n"
             "goes back. Exposure is in stops, before the transform; Mix 0 is the picture as it was.\n") +
         "\n" + sip::dctlText(grid);
}

std::string shaderText(sip::DeviceDialect dialect, const sip::DeviceTables& tables, const LutDescription& description) {
  std::string text = headOf(description);
  text += comments(
      "metamerMap() takes a linear pixel of that space, of any exposure. Its tables, nodes (four floats each) and "
      "cells\n"
      "(32 bits each), lie in the comment at the end: base64 of little-endian words, nodes first. Upload them once.\n");
  text += comments(exampleOf(dialect)) + "\n";
  text += sip::deviceText(dialect, sip::DeviceKernel::Map);
  text += "\n";
  text += kTables;
  text += std::to_string(tables.nodes.size()) + " nodes, " + std::to_string(tables.cells.size()) + " cells\n";
  const std::string bytes = bytesOf(tables);
  std::string letters(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(letters.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  letters.pop_back();
  for (std::size_t at = 0; at < letters.size(); at += kLine) {
    text.append(letters, at, kLine);
    text += '\n';
  }
  return text + "*/\n";
}

sip::DeviceTables shaderTables(const std::string& text) {
  const auto refuse = [](const std::string& remedy) {
    throw InputError("", "metamer tables", "", remedy + "; bake the shader file again");
  };
  const std::size_t found = text.find(kTables);
  if (found == std::string::npos) {
    refuse("are not in the text");
  }
  std::istringstream stream(text.substr(found + kTables.size()));
  std::size_t nodeCount = 0;
  std::size_t cellCount = 0;
  std::string word;
  stream >> nodeCount >> word >> cellCount >> word;
  // A map holds less than a gigabyte.
  constexpr std::size_t kMost = 1U << 26U;
  if (!stream || nodeCount == 0 || nodeCount > kMost || cellCount > kMost) {
    refuse("do not say how many they are");
  }
  std::string letters;
  for (std::string line; stream >> line && line != "*/";) {
    letters += line;
  }
  sip::DeviceTables tables;
  tables.nodes.resize(nodeCount);
  tables.cells.resize(cellCount);
  const std::size_t nodeBytes = sizeof(tables.nodes[0]) * nodeCount;
  const std::size_t cellBytes = sizeof(tables.cells[0]) * cellCount;
  std::string bytes(3 * (letters.size() / 4), '\0');
  if (letters.size() != 4 * ((nodeBytes + cellBytes + 2) / 3) ||
      EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                      reinterpret_cast<const unsigned char*>(letters.data()), static_cast<int>(letters.size())) < 0) {
    refuse("are cut short or not base64");
  }
  std::memcpy(tables.nodes.data(), bytes.data(), nodeBytes);
  std::memcpy(tables.cells.data(), bytes.data() + nodeBytes, cellBytes);
  return tables;
}

}  // namespace metamer::ocio
