// Include next to palpate.hpp for tissues that touch each other, or themselves: TouchingTissues, and the thread that
// solves their contact.
#pragma once

#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/touching_tissues.hpp>
#include <palpate/haptic/background_worker.hpp>
