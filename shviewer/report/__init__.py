"""Speed against error on the machine at hand: what is measured, and the page, the rows and the plots made of it."""
