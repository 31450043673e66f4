"""What is plotted: the curve under the panes, and sheets over them."""
