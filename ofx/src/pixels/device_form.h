// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "metamer/sip/device_kernels.h"

namespace metamer::ofx {

/// Tables that kernels of other devices read, with the copies of them that lie there. The copies live as long as this
/// does, which lives as long as what the tables are of. Safe between threads.
class ResidentTables {
 public:
  /// What a device keeps of the tables.
  struct Copy {
    virtual ~Copy() = default;
  };
  using Upload = std::function<std::shared_ptr<const Copy>(const sip::DeviceTables&)>;

  /// @param make  makes the tables; called once for each place that they are copied to
  explicit ResidentTables(std::function<sip::DeviceTables()> make) : m_make(std::move(make)) {}

  /// The copy at a place (a context of a device), made by `upload` where there is none yet. The latest few places are
  /// remembered; who holds a copy keeps it.
  /// @throws what upload throws; nothing is kept then
  std::shared_ptr<const Copy> copyAt(const void* place, const Upload& upload) const {
    const std::lock_guard lock(m_mutex);
    for (const Kept& kept : m_copies) {
      if (kept.place == place) {
        return kept.copy;
      }
    }
    m_copies.push_front({place, upload(m_make())});
    if (m_copies.size() > kKeptCopies) {
      m_copies.pop_back();
    }
    return m_copies.front().copy;
  }

 private:
  struct Kept {
    const void* place;
    std::shared_ptr<const Copy> copy;
  };
  static constexpr std::size_t kKeptCopies = 4;

  std::function<sip::DeviceTables()> m_make;
  mutable std::mutex m_mutex;
  mutable std::list<Kept> m_copies;  ///< latest first
};

/// What other devices run in the place of a PixelTransform's apply(): a kernel of the device room, and its tables.
struct DeviceForm {
  enum class Kernel { Copy, Map, Skin, Affine };

  Kernel kernel = Kernel::Copy;  ///< reads no tables
  const ResidentTables* tables = nullptr;
  /// Of a SignalTable, where pixels are decoded before and encoded after; null: they are not. Affine has its curve in
  /// its own tables.
  const ResidentTables* curve = nullptr;
};

}  // namespace metamer::ofx
