// Nothing but the precompiled header's owner.
#include "support/headers.hpp"
