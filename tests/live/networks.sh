#!/bin/bash
# Two to four robots on hosts of their own (network namespaces on a bridge), and one thing that happens to the network.
# Usage: unshare -Urnm bash networks.sh OUTRIDER WORK-DIR SPEED cut|halves|interface
# Writes DIR/ROBOT.json for each robot. Everything vanishes with the namespace.
set -eu
outrider=$1 dir=$2 speed=$3 what=$4
robots="a b c d"
mount -t tmpfs tmpfs /run
mkdir -p /run/netns
ip netns add air
ip -n air link add br0 type bridge mcast_snooping 0 stp_state 0 forward_delay 0
ip -n air link set br0 up
connect() {  # robot number
  ip link add e0 netns "$1" type veth peer name "p$1" netns air
  ip -n air link set "p$1" master br0 up
  ip -n "$1" addr add "10.77.0.$((10 + $2))/24" dev e0
  ip -n "$1" link set e0 up
  ip -n "$1" route add 224.0.0.0/4 dev e0
}
n=0
for r in $robots; do
  ip netns add "$r"
  ip -n "$r" link set lo up
  connect "$r" "$n"
  n=$((n + 1))
done
cd "$dir"
for r in $robots; do
  ip netns exec "$r" "$outrider" robot rooms.txt --team team.yaml --name "$r" --arena arena --run 5 --speed "$speed" \
    --url 'udpm://239.255.76.67:7667?ttl=1' --json -q >"$r.json" 2>"$r.err" &
done
wait_s() { sleep "$(awk "BEGIN { print $1 / $speed }")"; }  # seconds of the run
wait_s 5
case $what in
  cut)        # 25 s without one robot
    ip -n air link set pb down; wait_s 25; ip -n air link set pb up ;;
  halves)     # two bridges for a while
    ip -n air link add br1 type bridge mcast_snooping 0 stp_state 0 forward_delay 0
    ip -n air link set br1 up
    for r in c d; do ip -n air link set "p$r" master br1; done
    wait_s 25
    for r in c d; do ip -n air link set "p$r" master br0; done ;;
  interface)  # goes away and comes back
    ip -n b link del e0; wait_s 15; connect b 1 ;;
esac
wait
