"""Speed against error on the machine at hand: the measurements, the hard cases, and the report made from them."""
