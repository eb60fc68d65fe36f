#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

class Report;
using ReportPtr = std::shared_ptr<const Report>;

/// Figures and small pictures, in the order in which they were added. Immutable; thread-safe.
class Report {
 public:
  struct Figure {
    std::string name;
    std::variant<double, std::string> value;
    std::string help;  ///< what the figure means and which way is better; one line
  };
  struct Picture {
    std::string name;
    ImagePtr image;
  };
  static ReportPtr make(std::string title, std::vector<Figure> figures, std::vector<Picture> pictures = {});

  const std::string& title() const { return title_; }
  const std::vector<Figure>& figures() const { return figures_; }
  const std::vector<Picture>& pictures() const { return pictures_; }
  const Digest& digest() const { return digest_; }

 private:
  Report() = default;
  std::string title_;
  std::vector<Figure> figures_;
  std::vector<Picture> pictures_;
  Digest digest_;
};

}  // namespace terrazzo
