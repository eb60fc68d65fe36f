#include "core/image/pixel_maker.h"

#include <new>

namespace terrazzo {

namespace {

template <typename Call>
auto blaming(const std::string& maker, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const Cancelled&) {
    throw;
  } catch (const PixelError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw PixelError(maker, e.what());
  } catch (...) {
    throw PixelError(maker, "what makes its pixels threw something other than a std::exception");
  }
}

}  // namespace

std::string PixelMaker::name() {
  return current_ ? current_->name_ : std::string();
}

Operation blaming_maker(Operation operation) {
  const std::string maker = PixelMaker::name();
  if (maker.empty()) return operation;
  operation.compute = [maker, inner = std::move(operation.compute)](std::span<const PixelView> sources,
                                                                    const Rect& region, float* out) {
    blaming(maker, [&] { inner(sources, region, out); });
  };
  if (operation.reads)
    operation.reads = [maker, inner = std::move(operation.reads)](size_t source, const Rect& region) {
      return blaming(maker, [&] { return inner(source, region); });
    };
  return operation;
}

}  // namespace terrazzo
