// Light is e^-count of the surfaces that it meets.
const bool by_count = true;
