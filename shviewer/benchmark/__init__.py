"""Speed against error on the machine at hand: what is measured, the hard cases, and the page made of them."""
