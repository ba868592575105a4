while read line; do echo '{"door":0}'; done
