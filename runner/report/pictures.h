#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/exemplar/uv_map.h"
#include "core/image/image.h"

/// Images on their way into a page: shrunk, and written as data URIs.
namespace terrazzo {

/// How often values of 0 to 1 occur, as shares: the mean of a pixel's colour channels counts.
using Histogram = std::array<float, 64>;

/// An image as a page shows it. Colours are shown in sRGB; values outside [0, 1] are clipped, but a height map that
/// leaves it is stretched to it; two channels are shown as red and green.
struct PagePicture {
  std::string uri;    ///< JPEG for large colours, else PNG
  std::string small;  ///< the same for a place of about 64 pixels
  Size size;          ///< of the image itself
  ImagePtr shrunk;    ///< what `uri` shows
  Histogram histogram{};
};

/// Shrinks the image to at most `longest` pixels a side. Pulls every pixel once.
PagePicture page_picture(const ImagePtr& image, int longest);

/// A uv map in colours: red says how far right in the exemplar a pixel is from, green how far down. At most `longest`
/// pixels a side; pixels between are left out, as the mean of two places means nothing.
ImagePtr uv_in_colours(const UvMap& uv, int longest);

/// The side at which `count` square pictures make a page that browsers still load quickly, at most `longest`.
int side_for(size_t count, int longest);

/// The pictures of a page. Each image is in it once, however often it is shown.
class PagePictures {
 public:
  /// The picture's name, an element's id: "picture-3". The first side asked for counts.
  std::string add(const ImagePtr& image, int longest);
  const PagePicture& operator[](const std::string& id) const { return pictures_.at(id).picture; }

  /// Whether `figure` has been called for it.
  bool is_shown(const std::string& id) const { return pictures_.at(id).on_page; }
  /// The picture as HTML, with a caption; a click shows it at full size. If it is on the page already, a copy that the
  /// page's script fills.
  std::string figure(const std::string& id, const std::string& caption);

 private:
  struct Shown {
    PagePicture picture;
    bool on_page = false;
  };
  std::map<std::string, Shown> pictures_;
  std::map<std::pair<std::string, Semantic>, std::string> ids_;  ///< by digest and meaning
};

}  // namespace terrazzo
