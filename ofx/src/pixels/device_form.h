// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "metamer/sip/device_kernels.h"

namespace metamer::ofx {

/// What other devices run in the place of a PixelTransform's apply(): a kernel and its tables. Copies of the tables on
/// devices live as long as the form, which lives as long as what the tables are of. Safe between threads.
class DeviceForm {
 public:
  /// By the kernel of the device room that has this name.
  enum class Kernel { Map, Skin };

  /// What a device keeps of the tables.
  struct Copy {
    virtual ~Copy() = default;
  };
  using Upload = std::function<std::shared_ptr<const Copy>(const sip::DeviceTables&)>;

  /// @param tables  makes them; called once for each place that they are copied to
  DeviceForm(Kernel kernel, std::function<sip::DeviceTables()> tables)
      : m_kernel(kernel), m_tables(std::move(tables)) {}

  Kernel kernel() const { return m_kernel; }

  /// The copy at a place (a context of a device), made by `upload` where there is none yet. A form remembers the latest
  /// few places; who holds a copy keeps it.
  /// @throws what upload throws; nothing is kept then
  std::shared_ptr<const Copy> copyAt(const void* place, const Upload& upload) const {
    const std::lock_guard lock(m_mutex);
    for (const Kept& kept : m_copies) {
      if (kept.place == place) {
        return kept.copy;
      }
    }
    m_copies.push_front({place, upload(m_tables())});
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

  Kernel m_kernel;
  std::function<sip::DeviceTables()> m_tables;
  mutable std::mutex m_mutex;
  mutable std::list<Kept> m_copies;  ///< latest first
};

}  // namespace metamer::ofx
